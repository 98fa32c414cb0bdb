#include <nlohmann/json.hpp>

#include "drawing/drawing.hpp"
#include "drawing/net_writer.hpp"
#include "net/counts.hpp"

namespace tessera::drawing {

std::string to_json(const net::HierarchicalNet& pages, const net::Net& net, int indent) {
  constexpr std::size_t bytes_per_element = 400;
  NetWriter all(pages.parts.sources);
  all.reserve((net.places().size() + net.transitions().size()) * bytes_per_element);
  all.object([&] {
    std::uint32_t index = 0;
    all.member("pages", [&] {
      all.list(pages.pages, [&](const net::Page&) { all.page(pages, net::PageId{index++}); });
    });
    all.member("fusions",
               [&] { all.list(pages.fusions, [&](const net::FusionSet& one) { all.fusion(one); }); });
    all.member("flat", [&] {
      all.object([&] {
        all.member("places", [&] { all.list(net.places(), [&](const net::Place& one) { all.place(one); }); });
        index = 0;
        all.member("transitions", [&] {
          all.list(net.transitions(),
                   [&](const net::Transition&) { all.transition(net, net::TransitionId{index++}); });
        });
      });
    });
    all.member("counts",
               [&] { all.raw(nlohmann::ordered_json::parse(net::to_json(net::count(pages, net))).dump()); });
  });
  const std::string text = all.take();
  return (indent < 0 ? text : nlohmann::ordered_json::parse(text).dump(indent)) + "\n";
}

}  // namespace tessera::drawing

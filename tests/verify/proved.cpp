#include "proved.hpp"

#include <stdexcept>

#include "layers/layers.hpp"
#include "layers/properties.hpp"
#include "net/flatten.hpp"
#include "spec/parser.hpp"

namespace tessera::verify {
namespace {

struct Built {
  spec::Model model;
  net::HierarchicalNet pages;
  net::Net net;
  std::vector<net::Property> properties;
};

Built built(const std::string& text) {
  diagnostics::Diagnostics source("spec.yaml", text);
  auto model = spec::parse(source);
  auto pages = model ? layers::build(*model, source) : std::nullopt;
  auto net = pages ? net::flatten(*pages, source) : std::nullopt;
  auto properties = net ? layers::properties(*model, *pages, *net, source) : std::nullopt;
  if (!properties) throw std::runtime_error(render(source) + text);
  return {std::move(*model), std::move(*pages), std::move(*net), std::move(*properties)};
}

}  // namespace

Proved proved(const std::string& text, std::chrono::seconds time, const std::vector<std::string>& only,
              const std::string& method) {
  Built all = built(text);
  ProveOptions options;
  options.time = time;
  options.only = only;
  options.method = method;
  const std::vector<net::Invariant> invariants = layers::invariants(all.model, all.pages, all.net);
  Report report = prove({all.net, &all.pages, invariants, all.properties}, options);
  return {std::move(all.net), std::move(report)};
}

std::vector<std::string> texts_of(const PropertyResult& property) {
  std::vector<std::string> texts;
  for (const SubsystemAtEnd& one : property.waits) texts.push_back(one.text);
  return texts;
}

net::Net flattened(const std::string& text) { return built(text).net; }

}  // namespace tessera::verify

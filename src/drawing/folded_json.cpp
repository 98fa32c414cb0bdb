#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "drawing/drawing.hpp"
#include "drawing/net_writer.hpp"

namespace tessera::drawing {
namespace {

/// The elements `first`, `first + 1`, ... of one kind.
struct Range {
  std::uint32_t first = 0, size = 0;
  [[nodiscard]] std::uint32_t end() const { return first + size; }
};

/// The part of a net that belongs to one agent, and the memories of channels that it uses.
struct Part {
  Range pages, places, transitions;
  net::SubsystemId subsystem{};         ///< the first one; none: it has none
  std::vector<std::uint32_t> channels;  ///< in the order in which its pages use them
  std::vector<std::uint32_t> memory;    ///< numbers of fused places, in that order
  std::vector<std::uint32_t> fusions;   ///< the same as fusion sets
  std::vector<std::uint32_t> use;       ///< for each fused node of its pages, the index into `memory`
};

std::uint32_t index_of(const std::vector<std::uint32_t>& list, std::uint32_t element) {
  return static_cast<std::uint32_t>(std::ranges::find(list, element) - list.begin());
}

/// The index of the element, which is added if it is new.
std::uint32_t index_in(std::vector<std::uint32_t>& list, std::uint32_t element) {
  const std::uint32_t index = index_of(list, element);
  if (index == list.size()) list.push_back(element);
  return index;
}

/// Finds the parts of a net, and which of them are alike.
///
/// Precondition: the pages and elements of an agent follow one another, as layers::build and net::flatten
/// make them.
class Folding {
 public:
  Folding(const net::HierarchicalNet& pages, const net::Net& net) : pages_(pages), net_(net) {
    find_memories();
    for (const net::Node& node : pages.pages.front().nodes)
      if (node.page.valid()) parts_.emplace_back().pages.first = node.page.value;
    for (std::size_t part = 0; part < parts_.size(); ++part) measure(part);
    find_shapes();
  }

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  /// For each part the index of its shape; for each shape the index of its first part.
  [[nodiscard]] const std::vector<std::uint32_t>& shapes() const { return shapes_; }
  [[nodiscard]] const std::vector<std::uint32_t>& firsts() const { return firsts_; }
  /// The number of the memory that a fusion set or a fused place belongs to: that of its channel. Behind the
  /// channels, the values of each fact are written like the memory of one.
  template <class Fused>
  [[nodiscard]] std::uint32_t memory_of(const Fused& fused) const {
    return fused.channel.valid()
               ? fused.channel.value
               : static_cast<std::uint32_t>(pages_.parts.channels.size()) + fused.fact.value;
  }
  /// The name of a memory.
  [[nodiscard]] std::string name_of(std::size_t memory) const {
    const std::size_t channels = pages_.parts.channels.size();
    if (memory < channels) return pages_.parts.channels[memory];
    const net::Parts::Fact& fact = pages_.parts.facts[memory - channels];
    return pages_.parts[fact.subsystem].path + "." + fact.name;
  }
  /// The fused places of each memory.
  [[nodiscard]] const std::vector<Range>& memories() const { return memories_; }
  /// The fused place of a set; nullopt: it has no members.
  [[nodiscard]] std::optional<std::uint32_t> place_of(net::FusionId set) const {
    return place_of_[set.value];
  }
  [[nodiscard]] Range places_of_the_system() const { return {0, first_of(net_.places(), 1)}; }
  [[nodiscard]] Range transitions_of_the_system() const { return {0, first_of(net_.transitions(), 1)}; }

 private:
  void find_memories() {
    memories_.resize(pages_.parts.channels.size() + pages_.parts.facts.size());
    place_of_.resize(pages_.fusions.size());
    std::vector<bool> used(pages_.fusions.size());
    for (const net::Page& page : pages_.pages)
      for (const net::Node& node : page.nodes)
        if (node.fusion.valid()) used[node.fusion.value] = true;
    std::uint32_t place = first_of(net_.places(), static_cast<std::uint32_t>(pages_.pages.size()));
    for (std::uint32_t set = 0; set < used.size(); ++set) {
      if (!used[set]) continue;
      Range& memory = memories_[memory_of(pages_.fusions[set])];
      if (memory.size++ == 0) memory.first = place;
      place_of_[set] = place++;
    }
  }

  /// The first element that belongs to that page or to a later one. Fused places come last.
  template <class Elements>
  [[nodiscard]] static std::uint32_t first_of(const Elements& elements, std::uint32_t page) {
    const auto found = std::ranges::partition_point(
        elements, [&](const auto& one) { return one.page.valid() && one.page.value < page; });
    return static_cast<std::uint32_t>(found - elements.begin());
  }

  void measure(std::size_t index) {
    Part& part = parts_[index];
    const std::uint32_t end = index + 1 < parts_.size() ? parts_[index + 1].pages.first
                                                        : static_cast<std::uint32_t>(pages_.pages.size());
    part.pages.size = end - part.pages.first;
    part.places.first = first_of(net_.places(), part.pages.first);
    part.places.size = first_of(net_.places(), end) - part.places.first;
    part.transitions.first = first_of(net_.transitions(), part.pages.first);
    part.transitions.size = first_of(net_.transitions(), end) - part.transitions.first;
    for (std::uint32_t page = part.pages.first; page < end; ++page) {
      const net::Page& drawn = pages_.pages[page];
      if (drawn.subsystem.valid()) part.subsystem = std::min(part.subsystem, drawn.subsystem);
      for (const net::Node& node : drawn.nodes) {
        if (node.operation.channel.valid()) index_in(part.channels, node.operation.channel.value);
        if (!node.fusion.valid()) continue;
        index_in(part.channels, memory_of(pages_.fusions[node.fusion.value]));
        index_in(part.fusions, node.fusion.value);
        part.use.push_back(index_in(part.memory, place_of_[node.fusion.value].value()));
      }
      for (const net::PageTransition& transition : drawn.transitions)
        if (transition.condition.channel.valid()) index_in(part.channels, transition.condition.channel.value);
    }
  }

  void find_shapes() {
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>,
             std::vector<std::uint32_t>>
        alike;
    for (const Part& part : parts_) {
      std::vector<std::uint32_t>& candidates =
          alike[{part.pages.size, part.places.size, part.transitions.size,
                 pages_.pages[part.pages.end() - 1].span.line}];
      const auto found = std::ranges::find_if(
          candidates, [&](std::uint32_t shape) { return are_alike(part, parts_[firsts_[shape]]); });
      if (found != candidates.end()) {
        shapes_.push_back(*found);
        continue;
      }
      candidates.push_back(static_cast<std::uint32_t>(firsts_.size()));
      shapes_.push_back(static_cast<std::uint32_t>(firsts_.size()));
      firsts_.push_back(static_cast<std::uint32_t>(&part - parts_.data()));
    }
  }

  /// Whether both are written as the same shape. The elements of the flat net follow from the pages.
  [[nodiscard]] bool are_alike(const Part& one, const Part& other) const {
    if (one.use != other.use || one.memory.size() != other.memory.size() ||
        one.channels.size() != other.channels.size())
      return false;
    for (std::size_t at = 0; at < one.memory.size(); ++at)
      if (within(one, at) != within(other, at)) return false;
    for (std::uint32_t page = 0; page < one.pages.size; ++page)
      if (!are_alike(one, pages_.pages[one.pages.first + page], other, pages_.pages[other.pages.first + page],
                     page == 0))
        return false;
    return true;
  }

  /// The number of the channel among those of the part, and of the place within the memory of the channel.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> within(const Part& part, std::size_t at) const {
    const std::uint32_t channel = memory_of(net_.places()[part.memory[at]]);
    return {index_of(part.channels, channel), part.memory[at] - memories_[channel].first};
  }

  /// top: the pages of the agents themselves, which have other names.
  [[nodiscard]] static bool are_alike(const Part& one, const net::Page& a, const Part& other,
                                      const net::Page& b, bool top) {
    const auto relative = [](auto id, std::uint32_t first) {
      return id.valid() ? std::optional(id.value - first) : std::nullopt;
    };
    const auto same_channel = [&](net::ChannelId of_a, net::ChannelId of_b) {
      return index_of(one.channels, of_a.value) == index_of(other.channels, of_b.value);
    };
    const auto same_span = [](const net::Span& x, const net::Span& y) {
      return x.line == y.line && x.column == y.column && x.length == y.length;
    };
    const auto same_operation = [&](const net::Operation& x, const net::Operation& y) {
      return x.kind == y.kind && x.behaviour == y.behaviour && same_channel(x.channel, y.channel);
    };
    const auto same_condition = [&](const net::Condition& x, const net::Condition& y) {
      return x.kind == y.kind && x.truth == y.truth && x.known(true).truth == y.known(true).truth &&
             x.entry == y.entry && x.text == y.text && same_channel(x.channel, y.channel);
    };
    const auto same_node = [&](const net::Node& x, const net::Node& y) {
      return x.name == y.name && relative(x.page, one.pages.first) == relative(y.page, other.pages.first) &&
             x.fusion.valid() == y.fusion.valid() && x.tokens == y.tokens &&
             same_operation(x.operation, y.operation);
    };
    const auto same_transition = [&](const net::PageTransition& x, const net::PageTransition& y) {
      return x.name == y.name && x.inputs == y.inputs && x.outputs == y.outputs &&
             same_condition(x.condition, y.condition) && x.role == y.role && same_span(x.span, y.span);
    };
    return (top || (a.name == b.name &&
                    relative(a.parent, one.pages.first) == relative(b.parent, other.pages.first))) &&
           a.layer == b.layer &&
           relative(a.subsystem, one.subsystem.value) == relative(b.subsystem, other.subsystem.value) &&
           a.input == b.input && a.output == b.output && same_span(a.span, b.span) &&
           std::ranges::equal(a.nodes, b.nodes, same_node) &&
           std::ranges::equal(a.transitions, b.transitions, same_transition);
  }

  const net::HierarchicalNet& pages_;
  const net::Net& net_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> shapes_, firsts_;
  std::vector<Range> memories_;
  std::vector<std::optional<std::uint32_t>> place_of_;
};

/// Writes the system's own net: numbers of the whole net.
class SystemWriter : public NetWriter {
 public:
  SystemWriter(const Folding& folding, const diagnostics::Sources& sources)
      : NetWriter(sources), folding_(folding) {}

 protected:
  using NetWriter::written;
  [[nodiscard]] std::optional<std::uint32_t> written(net::FusionId id) const override {
    return folding_.place_of(id);
  }
  const Folding& folding_;
};

/// Writes a shape: numbers count within the agent.
class ShapeWriter : public SystemWriter {
 public:
  ShapeWriter(const Folding& folding, const diagnostics::Sources& sources, const Part& part,
              std::size_t prefix)
      : SystemWriter(folding, sources), part_(part), prefix_(prefix) {}

 protected:
  [[nodiscard]] std::optional<std::uint32_t> written(net::PageId id) const override {
    if (id.value < part_.pages.first) return std::nullopt;
    return id.value - part_.pages.first;
  }
  [[nodiscard]] std::optional<std::uint32_t> written(net::PlaceId id) const override {
    const std::uint32_t own = id.value - part_.places.first;
    return id.value >= part_.places.first && own < part_.places.size
               ? own
               : part_.places.size + index_of(part_.memory, id.value);
  }
  [[nodiscard]] std::optional<std::uint32_t> written(net::FusionId id) const override {
    return part_.places.size + index_of(part_.fusions, id.value);
  }
  [[nodiscard]] std::optional<std::uint32_t> written(net::SubsystemId id) const override {
    return id.value - part_.subsystem.value;
  }
  [[nodiscard]] std::optional<std::uint32_t> written(net::ChannelId id) const override {
    return index_of(part_.channels, id.value);
  }
  [[nodiscard]] std::string_view name(std::string_view path) const override {
    return path.substr(std::min(path.size(), prefix_));
  }

 private:
  const Part& part_;
  std::size_t prefix_;
};

/// Writes the places of a channel's memory: names without that of the channel, whose number is not written.
class MemoryWriter : public NetWriter {
 public:
  MemoryWriter(const diagnostics::Sources& sources, std::size_t prefix)
      : NetWriter(sources), prefix_(prefix) {}

 protected:
  using NetWriter::written;
  [[nodiscard]] std::optional<std::uint32_t> written(net::ChannelId) const override { return 0; }
  [[nodiscard]] std::string_view name(std::string_view path) const override {
    return path.substr(std::min(path.size(), prefix_));
  }

 private:
  std::size_t prefix_;
};

/// Writes the members that say where elements are: {"pages": [...], "places": [...], "transitions": [...]}.
void write_elements(NetWriter& writer, const net::HierarchicalNet& pages, const net::Net& net, Range of_pages,
                    Range of_places, Range of_transitions) {
  const auto list = [&](const char* name, Range range, auto each) {
    std::vector<std::uint32_t> numbers(range.size);
    for (std::uint32_t at = 0; at < range.size; ++at) numbers[at] = range.first + at;
    writer.member(name, [&] { writer.list(numbers, each); });
  };
  list("pages", of_pages, [&](std::uint32_t page) { writer.page(pages, net::PageId{page}); });
  list("places", of_places, [&](std::uint32_t place) { writer.place(net.places()[place]); });
  list("transitions", of_transitions,
       [&](std::uint32_t transition) { writer.transition(net, net::TransitionId{transition}); });
}

std::string shape_text(const Folding& folding, const net::HierarchicalNet& pages, const net::Net& net,
                       const Part& part) {
  ShapeWriter shape(folding, pages.parts.sources, part, pages.pages[part.pages.first].name.size() + 1);
  shape.object([&] {
    write_elements(shape, pages, net, part.pages, part.places, part.transitions);
    std::uint32_t subsystems = 0;
    for (std::uint32_t page = part.pages.first; page < part.pages.end(); ++page)
      if (pages.pages[page].layer == net::Layer::subsystem && !pages.pages[page].is_group()) ++subsystems;
    shape.member("subsystems", subsystems);
    shape.member("memory", [&] {
      shape.list(part.memory, [&](std::uint32_t place) {
        const std::uint32_t channel = folding.memory_of(net.places()[place]);
        const std::array<std::uint32_t, 2> where{index_of(part.channels, channel),
                                                 place - folding.memories()[channel].first};
        shape.list(where, [&](std::uint32_t number) { shape.value(number); });
      });
    });
  });
  return shape.take();
}

std::string memory_text(const net::Net& net, Range memory, std::string_view channel) {
  MemoryWriter writer(net.parts().sources, channel.size() + 1);
  std::vector<std::uint32_t> places(memory.size);
  for (std::uint32_t at = 0; at < memory.size; ++at) places[at] = memory.first + at;
  writer.list(places, [&](std::uint32_t place) { writer.place(net.places()[place]); });
  return writer.take();
}

}  // namespace

std::string to_folded_json(const net::HierarchicalNet& pages, const net::Net& net) {
  const Folding folding(pages, net);
  // Memories of channels of one form are written once. A text is short: a channel has few places.
  std::map<std::string, std::uint32_t> known;
  std::vector<std::string> memories;
  std::vector<std::uint32_t> memory_of;
  for (std::size_t channel = 0; channel < folding.memories().size(); ++channel) {
    std::string text = memory_text(net, folding.memories()[channel], folding.name_of(channel));
    const auto [at, is_new] = known.try_emplace(std::move(text), static_cast<std::uint32_t>(known.size()));
    if (is_new) memories.push_back(at->first);
    memory_of.push_back(at->second);
  }

  SystemWriter all(folding, pages.parts.sources);
  const auto numbers = [&](const std::vector<std::uint32_t>& list) {
    all.list(list, [&](std::uint32_t number) { all.value(number); });
  };
  all.object([&] {
    all.member("system", [&] {
      all.object([&] {
        write_elements(all, pages, net, {0, 1}, folding.places_of_the_system(),
                       folding.transitions_of_the_system());
      });
    });
    all.member("shapes", [&] {
      all.list(folding.firsts(), [&](std::uint32_t first) {
        all.raw(shape_text(folding, pages, net, folding.parts()[first]));
      });
    });
    all.member("agents", [&] {
      std::size_t index = 0;
      all.list(folding.parts(), [&](const Part& part) {
        all.object([&] {
          all.member("name", std::string_view(pages.pages[part.pages.first].name));
          all.member("shape", folding.shapes()[index++]);
          all.member("channels", [&] { numbers(part.channels); });
        });
      });
    });
    all.member("memories", [&] { all.list(memories, [&](const std::string& text) { all.raw(text); }); });
    all.member("channels", [&] {
      std::size_t index = 0;
      all.list(memory_of, [&](std::uint32_t memory) {
        all.object([&] {
          all.member("name", std::string_view(folding.name_of(index++)));
          all.member("memory", memory);
        });
      });
    });
  });
  return all.take();
}

}  // namespace tessera::drawing

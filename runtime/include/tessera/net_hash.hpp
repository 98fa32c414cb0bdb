#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tessera {

/// The identity of a flat net. Two nets with the same places, markings, transitions, arcs and kinds of
/// condition have the same hash, in whatever order they are stored. The generator embeds the hash; the
/// controller computes it again from its tables before the first firing.
class NetHash {
 public:
  void place(std::string_view name, std::uint32_t tokens) {
    Element element("place");
    element.text(name);
    element.number(tokens);
    add(element);
  }

  /// guard: "" | "go_on" | "terminal" | "error" | "next:K" | "elapsed". The order of inputs and
  /// of outputs does not count.
  void transition(std::string_view name, std::vector<std::string_view> inputs,
                  std::vector<std::string_view> outputs, std::string_view guard) {
    Element element("transition");
    element.text(name);
    for (std::vector<std::string_view>* side : {&inputs, &outputs}) {
      std::sort(side->begin(), side->end());
      element.number(side->size());
      for (std::string_view place : *side) element.text(place);
    }
    element.text(guard);
    add(element);
  }

  /// 32 hexadecimal digits.
  [[nodiscard]] std::string hex() const {
    std::string digits;
    for (std::uint64_t lane : sums_)
      for (int shift = 60; shift >= 0; shift -= 4) digits += "0123456789abcdef"[(lane >> shift) & 15U];
    return digits;
  }

 private:
  // FNV-1a in two lanes with different offsets, finished by the mixer of splitmix64 so that sums do not
  // cancel out.
  struct Element {
    static constexpr std::uint64_t prime = 0x100000001b3U;
    std::array<std::uint64_t, 2> lanes{0xcbf29ce484222325U, 0x9ae16a3b2f90404fU};
    explicit Element(std::string_view kind) { text(kind); }
    void byte(unsigned char value) {
      for (std::uint64_t& lane : lanes) lane = (lane ^ value) * prime;
    }
    void number(std::uint64_t value) {
      for (int shift = 0; shift < 64; shift += 8) byte(static_cast<unsigned char>(value >> shift));
    }
    void text(std::string_view value) {
      auto [first, second] = lanes;  // a local loop: programs are hashed too, and tests are not optimised
      for (const char character : value) {
        first = (first ^ static_cast<unsigned char>(character)) * prime;
        second = (second ^ static_cast<unsigned char>(character)) * prime;
      }
      lanes = {first, second};
      byte(0xff);  // so that no name is a prefix of another
    }
  };
  void add(const Element& element) {
    for (std::size_t lane = 0; lane < sums_.size(); ++lane) {
      std::uint64_t mixed = element.lanes[lane] + 0x9e3779b97f4a7c15U * (lane + 1);
      mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9U;
      mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebU;
      sums_[lane] += mixed ^ (mixed >> 31);
    }
  }
  std::array<std::uint64_t, 2> sums_{};
};

}  // namespace tessera

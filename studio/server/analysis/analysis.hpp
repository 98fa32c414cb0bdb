#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "net/property.hpp"
#include "spec/model/model.hpp"

namespace tessera::server {

/// What is known about a text, however broken it is.
struct Analysis {
  std::shared_ptr<const std::string> json;  ///< docs/studio.md, `analysis`
  /// Of a text without errors:
  std::optional<spec::Model> model;
  std::optional<net::HierarchicalNet> pages;
  std::optional<net::Net> net;
  std::vector<net::Property> properties;  ///< of the author; none if one of them is wrong
  std::string net_hash;
};

/// name: of the file, for messages.
///
/// Threads: pure.
[[nodiscard]] Analysis analyse(const std::string& name, const std::string& text);

/// The last few analyses by their text: several browsers ask about the same one.
///
/// Threads: any.
class Analyses {
 public:
  explicit Analyses(std::string name) : name_(std::move(name)) {}
  [[nodiscard]] std::shared_ptr<const Analysis> of(const std::string& text);

 private:
  struct Kept {
    std::string revision;
    std::shared_ptr<const Analysis> analysis;
  };
  static constexpr std::size_t most_kept = 4;
  std::string name_;
  std::mutex mutex_;
  std::deque<Kept> kept_;
};

}  // namespace tessera::server

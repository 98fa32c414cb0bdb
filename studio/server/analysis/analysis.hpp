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

/// Everything that is known about a text, even if it has errors.
struct Analysis {
  std::shared_ptr<const std::string> json;  ///< the message `analysis` of docs/studio.md
  /// Set only if the text has no errors:
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

/// The last few analyses by their texts, because several browsers ask about the same text.
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

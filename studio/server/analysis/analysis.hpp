#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "net/net.hpp"
#include "net/property.hpp"
#include "spec/model/model.hpp"

namespace tessera::server {

/// The complete analysis of a text, even of one with errors.
struct Analysis {
  std::shared_ptr<const std::string> json;  ///< the message `analysis` of docs/reference/studio.md
  /// Set only if the text has no errors:
  std::optional<spec::Model> model;
  std::optional<net::HierarchicalNet> pages;
  std::optional<net::Net> net;
  std::vector<net::Property> properties;  ///< of the author; none if one of them is wrong
  std::string net_hash;
  std::vector<std::filesystem::path>
      included;                   ///< files that the text includes, also those that cannot be read
  std::string state_of_included;  ///< server::state_of them, when they were read; "": not known
};

/// When each of the files was changed for the last time. Another text: one of them may have another content.
[[nodiscard]] std::string state_of(const std::vector<std::filesystem::path>& files);

/// name: of the file, for messages. project: its folder, with the messages of ROS 2 and the included files; empty: it
/// looks up none.
///
/// Threads: any.
[[nodiscard]] Analysis analyse(const std::string& name, const std::string& text,
                               const std::filesystem::path& project = {});

/// The last few analyses by their texts, because several browsers, and several requests of one, concern the
/// same text. Each text is analysed once, and again when a file that it includes has changed.
///
/// Threads: any.
class Analyses {
 public:
  explicit Analyses(std::filesystem::path file) : file_(std::move(file)) {}
  [[nodiscard]] std::shared_ptr<const Analysis> of(const std::string& text);

 private:
  struct Kept {
    std::string revision;
    std::shared_future<std::shared_ptr<const Analysis>> analysis;
  };
  static constexpr std::size_t most_kept = 4;
  std::filesystem::path file_;
  std::mutex mutex_;
  std::deque<Kept> kept_;
};

}  // namespace tessera::server

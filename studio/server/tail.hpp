#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "net/net.hpp"
#include "tessera/recording.hpp"

namespace tessera::server {

/// The bytes that a file has grown by. It need not exist yet.
class GrowingFile {
 public:
  explicit GrowingFile(std::filesystem::path file) : path_(std::move(file)) {}
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  /// At most `most` bytes at a time; empty: nothing new.
  [[nodiscard]] std::string more(std::size_t most = std::size_t{4} << 20U);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Names of a recording's transitions to indices of a net.
class TransitionMap {
 public:
  explicit TransitionMap(const net::Net& net);
  /// UINT32_MAX: the net has no such transition.
  [[nodiscard]] std::vector<std::uint32_t> of(const Recording& recording) const;

 private:
  std::vector<std::pair<std::string, std::uint32_t>> by_name_;  // sorted
};

/// Follows a run by the recording that it writes, at no cost to it: what has fired, and where the tokens are.
class RecordingTail {
 public:
  RecordingTail(std::filesystem::path file, const net::Net& net);

  static constexpr std::size_t most_firings = 2000;
  struct Batch {
    std::int64_t time_ns = 0;   ///< of the last firing
    std::uint64_t dropped = 0;  ///< firings that are not listed, before those that are
    std::vector<std::pair<std::int64_t, std::uint32_t>> firings;  ///< time, transition of the net
    std::vector<std::pair<std::int64_t, std::string>> messages;   ///< of the log, and why it stopped
    bool more = false;                                            ///< the file may have more already
  };
  /// What has been written since, as far as it can be read in a few milliseconds; nullopt: nothing.
  [[nodiscard]] std::optional<Batch> next();
  /// Places with a token after all that `next` has read.
  [[nodiscard]] std::vector<std::uint32_t> marking() const;
  /// Of the recording; empty before its header has been read.
  [[nodiscard]] std::string net_hash() const { return hash_; }
  [[nodiscard]] std::uint64_t firings() const { return count_; }

 private:
  void play(std::uint32_t transition);
  [[nodiscard]] bool read_header();
  void take(Batch& batch);
  GrowingFile file_;
  const net::Net& net_;
  TransitionMap map_;
  RecordingReader reader_;
  std::string hash_;
  std::vector<std::uint32_t> transitions_;  ///< of the recording: indices of the net
  std::vector<std::int32_t> tokens_;  ///< may be below 0 for a moment: threads write when they come to it
  std::uint64_t count_ = 0;
};

}  // namespace tessera::server

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "bag/bag_writer.hpp"
#include "tessera/growing_recording.hpp"
#include "tessera/recording.hpp"

namespace tessera::bag {

/// Writes a bag while a run writes its recording. It only reads the recording, in a thread of the process that has started
/// the run, so that the controller does nothing for it.
///
/// Each second it writes one chunk, whole. If it is killed, the file holds every chunk but the last. If the file
/// cannot be written any more, because the disk is full, it is cut back to its last whole chunk, and nothing more
/// is written.
///
/// Threads: one.
class LiveBag {
 public:
  /// recording: the file that the run will write. Throws std::runtime_error: the bag cannot be written.
  LiveBag(const std::string& recording, std::string file, Background background, std::string library);
  /// Stops without the end.
  ~LiveBag();
  LiveBag(const LiveBag&) = delete;
  LiveBag& operator=(const LiveBag&) = delete;

  /// The run is over: writes the rest and the index. Returns what went wrong; empty: nothing.
  [[nodiscard]] std::string finish();

 private:
  void follow();
  [[nodiscard]] bool read_on();
  void write_chunk();
  void write(const std::string& bytes);

  GrowingRecording recording_;
  std::string file_;
  Background background_;
  std::string library_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;  // of the whole chunks in the file
  std::unique_ptr<RecordingReader> reader_;
  std::unique_ptr<BagWriter> writer_;
  std::uint64_t lost_ = 0;  // in earlier segments
  std::int64_t last_ns_ = 0, written_ns_ = 0;
  std::string problem_;
  std::atomic<bool> stops_ = false;
  std::thread thread_;
};

}  // namespace tessera::bag

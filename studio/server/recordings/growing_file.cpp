#include "server/recordings/growing_file.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace tessera::server {

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::string GrowingFile::more(std::size_t most) {
  if (descriptor_ < 0) descriptor_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor_ < 0) return {};
  std::string bytes(most, '\0');
  const ssize_t count = read(descriptor_, bytes.data(), bytes.size());
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

}  // namespace tessera::server

#include "project/packaging/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace tessera::project {

ScratchFolder::ScratchFolder(const std::filesystem::path& beside) {
  std::string name =
      ((beside.empty() ? std::filesystem::temp_directory_path() : beside) / ".tessera-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw std::runtime_error("cannot make a folder " + name + ": " + std::strerror(errno));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace tessera::project

#include "sim/mjcf/compile.hpp"

#include <cstring>
#include <limits>
#include <memory>

namespace tessera::sim {

Result<ModelPtr> compile_text(const std::string& mjcf) {
  static const std::string name = "tessera_composed.xml";
  if (mjcf.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 4))
    return Problem{"the composed world is larger than 500 MB as text"};
  struct Release {
    void operator()(mjVFS* files) const {
      mj_deleteVFS(files);
      delete files;
    }
  };
  const std::unique_ptr<mjVFS, Release> files(new mjVFS);
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(mjcf.size())) != 0)
    return Problem{"there is not enough memory for the composed world"};
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), name.c_str())], mjcf.data(), mjcf.size());
  Result<ModelPtr> model = load_model(name, files.get());
  if (model) return model;
  return Problem{model.problem().substr(name.size() + 2)};
}

}  // namespace tessera::sim

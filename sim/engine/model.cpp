#include "sim/engine/model.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <string_view>
#include <utility>

#include "sim/engine/complaint.hpp"

namespace tessera::sim {
namespace {

/// Words of MJCF that later versions of the engine brought.
constexpr std::array newer_words = std::to_array<std::string_view>({"implicitfast",
                                                                    "kv",
                                                                    "dampratio",
                                                                    "inheritrange",
                                                                    "timeconst",
                                                                    "actuatorfrcrange",
                                                                    "actuatorfrclimited",
                                                                    "actuatorgravcomp",
                                                                    "gravcomp",
                                                                    "ellipsoidinertia",
                                                                    "inertiagrouprange",
                                                                    "assetdir",
                                                                    "frame",
                                                                    "replicate",
                                                                    "attach",
                                                                    "model",
                                                                    "memory",
                                                                    "distance",
                                                                    "normal",
                                                                    "fromto",
                                                                    "contact",
                                                                    "camprojection",
                                                                    "jointactuatorfrc",
                                                                    "tendonactuatorfrc",
                                                                    "resolution",
                                                                    "focal",
                                                                    "sensorsize",
                                                                    "principal",
                                                                    "flexcomp",
                                                                    "flex",
                                                                    "deformable",
                                                                    "plugin",
                                                                    "extension",
                                                                    "sdf",
                                                                    "autoreset",
                                                                    "island",
                                                                    "multiccd",
                                                                    "nativeccd",
                                                                    "eulerdamp",
                                                                    "delay",
                                                                    "actlimited",
                                                                    "actrange",
                                                                    "actearly",
                                                                    "shellinertia",
                                                                    "inertia",
                                                                    "maxhullvert",
                                                                    "orientation",
                                                                    "ls_iterations",
                                                                    "ls_tolerance",
                                                                    "noslip_iterations",
                                                                    "ccd_iterations",
                                                                    "sdf_iterations",
                                                                    "bvactive",
                                                                    "insidesite",
                                                                    "e_potential",
                                                                    "e_kinetic"});

/// "error, Element 'position', line 4": the engine writes it on several lines.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c != '\n')
      line += c;
    else if (!line.empty() && !line.ends_with(", "))
      line += ", ";
  }
  return line.ends_with(", ") ? line.substr(0, line.size() - 2) : line;
}

/// The engine's complaint, with a hint if the file was written for a later version.
std::string explained(const std::string& complaint) {
  std::string line = on_one_line(complaint);
  if (line.find("unrecognized") == std::string::npos && line.find("invalid keyword") == std::string::npos)
    return line;
  const std::size_t open = line.find('\''), close = line.find('\'', open + 1);  // its first quoted word
  if (close == std::string::npos) return line;
  const std::string word = line.substr(open + 1, close - open - 1);
  if (std::ranges::find(newer_words, word) == newer_words.end()) return line;
  return line + "; '" + word + "' needs a newer MuJoCo than this one, which is " + mj_versionString();
}

}  // namespace

Result<ModelPtr> load_model(const std::string& mjcf, const mjVFS* files) {
  static std::mutex loading;  // the engine's parser keeps global state
  const std::scoped_lock lock(loading);
  catch_complaints();
  std::array<char, 1024> message{};
  ModelPtr model;
  std::string complaint = complaint_of([&] {
    model.reset(mj_loadXML(mjcf.c_str(), files, message.data(), static_cast<int>(message.size())));
  });
  if (model && complaint.empty() && model->opt.timestep > 0.1)
    complaint = "the time step is longer than 0.1 s";
  if (model && complaint.empty()) return model;
  if (complaint.empty()) complaint = message.data();
  return Problem{mjcf + ": " + explained(complaint)};
}

}  // namespace tessera::sim

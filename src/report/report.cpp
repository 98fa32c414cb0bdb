#include "report/report.hpp"

#include "report/page.hpp"
#include "report/picture.hpp"

namespace tessera::report {

std::string several_robots(const std::string& names) {
  constexpr std::size_t longest = 80;
  const std::size_t comma = names.size() > longest ? names.rfind(',', longest) : std::string::npos;
  const std::string shown = comma == std::string::npos ? names : names.substr(0, comma) + ", ...";
  return "Several robots move in this world (" + shown +
         "): their way along the track is not measured. Name what you want to know under `measures`.";
}

std::vector<File> render(const ReportInput& input) {
  std::vector<File> files{{"index.html", page(input)}};
  if (input.drive)
    files.push_back({"path.png", path_png(*input.drive, input.recording.system, headline(input))});
  return files;
}

}  // namespace tessera::report

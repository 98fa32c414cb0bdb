#include "report/report.hpp"

#include "report/page.hpp"
#include "report/picture.hpp"

namespace tessera::report {

std::string several_robots(const std::string& names) {
  return "Several robots move in this world (" + names +
         "): paths, laps and errors are shown where there is one robot only.";
}

std::vector<File> render(const ReportInput& input) {
  std::vector<File> files{{"index.html", page(input)}};
  if (input.drive)
    files.push_back({"path.png", path_png(*input.drive, input.recording.system, headline(input))});
  return files;
}

}  // namespace tessera::report

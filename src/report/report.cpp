#include "report/report.hpp"

#include "report/page.hpp"
#include "report/picture.hpp"

namespace tessera::report {

std::vector<File> render(const ReportInput& input) {
  std::vector<File> files{{"index.html", page(input)}};
  if (input.drive)
    files.push_back({"path.png", path_png(*input.drive, input.recording.system, headline(input))});
  if (input.poster) files.push_back({"poster.png", png_of(input.poster->picture)});
  return files;
}

}  // namespace tessera::report

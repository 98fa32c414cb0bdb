#include "project/parameter_file.hpp"

#include <stdexcept>

#include "folder.hpp"

namespace tessera::project_test {
namespace {

class ParameterFile : public Folder {
 protected:
  /// The values in the order in which a run takes them over.
  [[nodiscard]] std::string read(const std::string& text) const {
    write("params.yaml", text);
    std::string all;
    for (const project::GivenParameter& one : project::read_parameter_file(folder_ / "params.yaml"))
      all += one.path + "=" + one.value + ";";
    return all;
  }
  /// The message about it, without the name of the folder.
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      return "accepted: " + read(text);
    } catch (const std::runtime_error& problem) {
      std::string message = problem.what();
      for (const std::string own = folder_.string() + "/"; message.find(own) != std::string::npos;)
        message.erase(message.find(own), own.size());
      return message;
    }
  }
};

TEST_F(ParameterFile, TheMoreSpecificPathComesLastInWhateverOrderTheLinesAre) {
  const std::string wanted = "v=3;a[*].v=1;a[2].v=4;a[*].control.v=5;a[2].control.v=6;";
  EXPECT_EQ(read("v: 3\na[*].v: 1\na[2].v: 4\na[*].control.v: 5\na[2].control.v: 6\n"), wanted);
  EXPECT_EQ(read("a[2].control.v: 6\na[*].control.v: 5\na[2].v: 4\na[*].v: 1\nv: 3\n"), wanted);
  EXPECT_EQ(read("a[2]: { control: { v: 6 }, v: 4 }\na[*]: { control: { v: 5 }, v: 1 }\nv: 3\n"), wanted);
}

TEST_F(ParameterFile, AValueGivenTwiceIsRefused) {
  EXPECT_EQ(refusal("v: 2\nv: 3\n"),
            "the parameters cannot be read\n"
            "params.yaml:2:1: error E009: duplicate key 'v'\n"
            "    2 | v: 3\n"
            "      | ^\n"
            "hint: the first one is on line 1; keep one of them\n"
            "1 error");
  EXPECT_EQ(refusal("a: { control: { v: 2 } }\na.control.v: 3\n"),
            "the parameters cannot be read\n"
            "params.yaml:2:1: error E009: a second value of 'a.control.v'\n"
            "    2 | a.control.v: 3\n"
            "      | ^~~~~~~~~~~\n"
            "hint: the first one is on line 1; keep one of them\n"
            "1 error");
}

TEST_F(ParameterFile, ASecondDocumentIsRefused) {
  EXPECT_EQ(refusal("v: 3\n---\nv: 4\n"),
            "the parameters cannot be read\n"
            "params.yaml:2:1: error E006: a second document begins here\n"
            "    2 | ---\n"
            "      | ^\n"
            "hint: one file holds one map of parameters\n"
            "1 error");
}

TEST_F(ParameterFile, AFolderIsNamedAsSuch) {
  EXPECT_THROW((void)project::read_parameter_file(folder_), std::runtime_error);
  EXPECT_EQ(refusal("# v: 3\n"), "accepted: ") << "a file may consist of comments";
  EXPECT_EQ(refusal(""), "accepted: ");
}

}  // namespace
}  // namespace tessera::project_test

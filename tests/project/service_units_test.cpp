#include "project/service_units.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "project/process/process.hpp"

namespace tessera::project {
namespace {

namespace fs = std::filesystem;

spec::Model deployed_model() {
  spec::Model model;
  model.system = "yard";
  model.deployment.emplace();
  model.deployment->processes.resize(3);
  model.deployment->processes[0].name = "office";
  model.deployment->processes[1].name = "cart[0]";
  model.deployment->processes[1].host = "cart.local";
  model.deployment->processes[2].name = "cart[1]";
  model.deployment->processes[2].host = "cart.local";
  return model;
}

struct UnitFolder : testing::Test {
  UnitFolder() : folder(fs::temp_directory_path() / ("tessera_units_" + std::to_string(getpid()))) {}
  ~UnitFolder() override { fs::remove_all(folder); }
  fs::path folder;
};

TEST_F(UnitFolder, HasAUnitPerProcessInAFolderPerHost) {
  const std::vector<std::string> files = write_service_units(deployed_model(), folder.string());
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0], (folder / "any/yard-office.service").string());
  EXPECT_EQ(files[1], (folder / "cart.local/yard-cart-0.service").string());
  std::ifstream stream(files[1]);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_NE(text.find("run --process \"cart[0]\" --record /var/lib/yard/yard-cart-0.tsr"), std::string::npos)
      << text;
  EXPECT_NO_THROW(write_service_units(deployed_model(), folder.string()))
      << "its own files are written again";
  std::ofstream(files[1]) << "[Unit]\n";
  EXPECT_THROW(write_service_units(deployed_model(), folder.string()), std::runtime_error);
}

TEST_F(UnitFolder, IsAcceptedBySystemd) {
  if (!fs::exists("/usr/bin/systemd-analyze")) GTEST_SKIP() << "systemd is not installed";
  std::vector<ServiceUnit> units = service_units(deployed_model());
  // As packages have them.
  for (ServiceUnit& packed : service_units(
           deployed_model(),
           {.own_user = true, .groups = {"audio", "dialout"}, .parameters = true, .own_libraries = true})) {
    EXPECT_NE(packed.text.find("\nDynamicUser=yes\nUser=tessera-yard\n"), std::string::npos);
    EXPECT_NE(packed.text.find("\nEnvironment=XDG_RUNTIME_DIR=/run/yard\n"), std::string::npos)
        << "one folder, so that one emergency stop reaches all";
    EXPECT_NE(packed.text.find("\nSupplementaryGroups=audio dialout\n"), std::string::npos);
    units.push_back(std::move(packed));
  }
  EXPECT_NE(units.back().text.find("--record /var/lib/yard/yard-cart-1.tsr"), std::string::npos);
  for (ServiceUnit& unit : units) {
    EXPECT_EQ(unit.text.find('{'), std::string::npos) << unit.text;
    // It asks for the program, too.
    const std::string program = "/opt/yard/controller";
    unit.text.replace(unit.text.find(program), program.size(), "/bin/true");
    fs::create_directories(folder);
    std::ofstream(folder / unit.file) << unit.text;
    const Exit verified = capture({"systemd-analyze", "verify", "--man=no", (folder / unit.file).string()});
    EXPECT_EQ(verified.code, 0) << verified.text;
    EXPECT_EQ(verified.text.find(unit.file), std::string::npos) << verified.text;
  }
}

}  // namespace
}  // namespace tessera::project

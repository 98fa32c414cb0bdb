// Several commands on one project at a time: each has a run of its own, made by the code that it built.
// TESSERA_SEVERAL=10 is the long form.

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "../environment.hpp"
#include "command.hpp"

namespace tessera::cli_test {

/// A folder whose name has characters that CMake, ninja, a shell or C++ may misread.
class Several : public Command {
 protected:
  Several() : root_(folder_) {
    folder_ = root_ / "odd \u0105 #%~=:,@!(b){c}+$x";
    fs::create_directories(folder_);
  }
  ~Several() override { folder_ = root_; }

 private:
  fs::path root_;
};

/// The outputs of commands that run at the same time, each with its exit code in front.
std::vector<std::string> at_once(const fs::path& folder, const std::vector<std::string>& arguments) {
  std::vector<std::string> printed(arguments.size());
  std::vector<std::thread> all;
  for (std::size_t index = 0; index < arguments.size(); ++index)
    all.emplace_back([&, index] {
      const std::atomic<bool> never{false};
      const project::Exit done = project::capture_apart(
          {"sh", "-c", "cd \"$0\" && " TESSERA_BINARY_DIR "/tessera " + arguments[index], folder.string()},
          never);
      printed[index] = std::to_string(done.code) + "\n" + done.text;
    });
  for (std::thread& one : all) one.join();
  return printed;
}

std::size_t runs_in(const fs::path& project) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(project / ".tessera/runs"), fs::directory_iterator()));
}

nlohmann::json outcome(const fs::path& file) {
  return nlohmann::json::parse(content_of(file), nullptr, false);
}

/// Waits for an effect of another process.
template <class Condition>
bool await(Condition&& condition) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

TEST_F(Several, CommandsAtOnceAreAllRight) {
  const std::uint64_t rounds = from_environment("TESSERA_SEVERAL", 1);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    if (rounds > 1) fmt::print("round {} of {}\n", round + 1, rounds), std::fflush(stdout);
    fs::remove_all(folder_ / "rover");
    ASSERT_EQ(tessera("new rover").code, 0);
    // The first build of all is made by one of them, and the others wait for it.
    const auto printed = at_once(folder_, {"simulate rover --for 20s --seed 1 --json 1.json",
                                           "simulate rover --for 20s --seed 1 --json 2.json",
                                           "simulate rover --for 10s --seed 2 --json 3.json"});
    for (const std::string& one : printed) ASSERT_TRUE(one.starts_with("0\n")) << one;
    const nlohmann::json first = outcome(folder_ / "1.json"), second = outcome(folder_ / "2.json"),
                         third = outcome(folder_ / "3.json");
    EXPECT_NE(first.at("recording"), second.at("recording"));
    EXPECT_EQ(content_of(first.at("recording").get<std::string>()),
              content_of(second.at("recording").get<std::string>()));
    EXPECT_EQ(first.at("laps"), second.at("laps"));
    EXPECT_NEAR(third.at("simulated_s"), 10, 0.1);
    EXPECT_EQ(runs_in(folder_ / "rover"), 3U);
  }
  // Tests, a simulation and two for the debugger, of which one builds the missing parts.
  const auto printed =
      at_once(folder_, {"test rover", "simulate rover --for 1s", "simulate rover --for 1s --debug",
                        "simulate rover --for 2s --debug"});
  for (const std::string& one : printed) EXPECT_TRUE(one.starts_with("0\n")) << one;
  EXPECT_NE(printed[0].find("[  PASSED  ]"), std::string::npos) << printed[0];
  const auto program = [](const std::string& text) {
    const std::size_t begin = text.find(" --args '") + 9;
    return text.substr(begin, text.find('\'', begin) - begin);
  };
  EXPECT_NE(program(printed[2]), program(printed[3]));
  EXPECT_TRUE(fs::exists(program(printed[2])));

  // A run that goes on while another builds different code and makes its own recording.
  const fs::path log = folder_ / "run.json";
  std::thread running([&] { at_once(folder_, {"run rover --world --for 8s --json run.json"}); });
  EXPECT_TRUE(await([&] {
    const fs::path last = folder_ / "rover/.tessera/last";
    return fs::read_symlink(last).string().find("-run-") != std::string::npos &&
           fs::exists(last / "recording.tsr");
  }));
  replace(folder_ / "rover/src/control.cpp", "void follow(", "// another one\nvoid follow(");
  const nlohmann::json meanwhile = json("simulate rover --for 1s");
  running.join();
  const nlohmann::json run = outcome(log);
  ASSERT_TRUE(run.is_object());
  EXPECT_NEAR(run.at("simulated_s"), 8, 0.5);
  EXPECT_NE(run.at("recording"), meanwhile.at("recording"));
  const project::Exit checked =
      tessera("replay --check --spec rover '" + run.at("recording").get<std::string>() + "'");
  EXPECT_EQ(checked.code, 0) << checked.text;

  // A waiting command names the one that it waits for.
  const int lock = open((folder_ / "rover/.tessera/build.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  ASSERT_EQ(flock(lock, LOCK_EX), 0);
  std::vector<std::string> waited;
  std::thread waiting([&] { waited = at_once(folder_, {"simulate rover --for 1s 2> waiting.txt"}); });
  EXPECT_TRUE(await(
      [&] { return content_of(folder_ / "waiting.txt").find("is being built by") != std::string::npos; }));
  close(lock);
  waiting.join();
  EXPECT_TRUE(waited.at(0).starts_with("0\n")) << waited.at(0);

  // A project of a version before has a folder in the place of the link.
  const fs::path last = folder_ / "rover/.tessera/last";
  fs::remove(last);
  write(last / "recording.tsr", "an old one");
  EXPECT_EQ(tessera("simulate rover --for 1s").code, 0);
  EXPECT_TRUE(fs::is_symlink(last));
  bool found = false;
  for (const auto& entry : fs::directory_iterator(folder_ / "rover/.tessera/runs"))
    found = found || content_of(entry.path() / "recording.tsr") == "an old one";
  EXPECT_TRUE(found);
  EXPECT_EQ(shell("cd rover && " TESSERA_BINARY_DIR "/tessera replay").code, 0);
}

}  // namespace tessera::cli_test

#include "project/files/run_folder.hpp"

#include <sys/file.h>

#include <cstdlib>
#include <optional>
#include <thread>

#include "folder.hpp"
#include "project/build/programs.hpp"

namespace tessera::project_test {
namespace {

using project::RunFolder;

class RunFolders : public Folder {
 protected:
  ~RunFolders() override {
    unsetenv("TESSERA_KEEP_RUNS");
    unsetenv("TESSERA_KEEP_RUNS_SIZE");
  }
  RunFolder begin(RunFolder::Shown shown = RunFolder::Shown::as_last) {
    return {folder_, "simulate", shown, said_};
  }
  /// A run that is over.
  fs::path finished(std::size_t bytes = 10) {
    const RunFolder run = begin();
    std::ofstream(run.path() / "recording.tsr") << std::string(bytes, 'x');
    return run.path();
  }
  Said said_;
};

TEST_F(RunFolders, EachRunHasItsOwnAndLastShowsTheNewest) {
  const fs::path first = finished();
  const RunFolder second = begin();
  EXPECT_NE(first, second.path());
  EXPECT_EQ(fs::canonical(folder_ / "last"), second.path());
  const RunFolder third = begin(RunFolder::Shown::no);
  EXPECT_EQ(fs::canonical(folder_ / "last"), second.path());
  EXPECT_TRUE(fs::exists(first / "recording.tsr"));
}

TEST_F(RunFolders, ManyAtOnceAreAllDifferent) {
  std::vector<std::thread> threads;
  std::vector<std::optional<RunFolder>> runs(16);
  for (auto& run : runs)
    threads.emplace_back([&] { run.emplace(folder_, "run", RunFolder::Shown::as_last, said_); });
  for (std::thread& thread : threads) thread.join();
  std::set<fs::path> paths;
  for (const auto& run : runs) paths.insert(run->path());
  EXPECT_EQ(paths.size(), runs.size());
  EXPECT_TRUE(paths.contains(fs::canonical(folder_ / "last")));
}

TEST_F(RunFolders, AFolderLastOfAnEarlierVersionBecomesARun) {
  write("last/recording.tsr", "old");
  write("last/notes.txt", "mine");
  const RunFolder run = begin();
  EXPECT_TRUE(fs::is_symlink(folder_ / "last"));
  std::size_t found = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "runs"))
    found += content_of(entry.path() / "recording.tsr") == "old" &&
             content_of(entry.path() / "notes.txt") == "mine";
  EXPECT_EQ(found, 1U);
}

TEST_F(RunFolders, TheOldestGoButNotThoseInUseOrKeptNorWhatOthersWrote) {
  setenv("TESSERA_KEEP_RUNS", "3", 1);
  std::optional<RunFolder> in_use(begin());
  const fs::path used = in_use->path(), kept = finished();
  write(kept / "keep", "");
  EXPECT_EQ(fs::exists(kept / "keep"), true);
  const fs::path noted = finished(), plain = finished();
  std::ofstream(noted / "notes.txt") << "mine";
  write("runs/letters/recording.tsr", "mine");
  write("elsewhere/recording.tsr", "mine");
  fs::create_directory_symlink("../elsewhere", folder_ / "runs/20200101-000000-simulate-1");
  for (int more = 0; more < 5; ++more) finished();
  EXPECT_TRUE(fs::exists(used));
  EXPECT_TRUE(fs::exists(kept / "recording.tsr"));
  EXPECT_FALSE(fs::exists(plain));
  EXPECT_FALSE(fs::exists(noted / "recording.tsr"));
  EXPECT_EQ(content_of(noted / "notes.txt"), "mine");
  EXPECT_EQ(content_of(folder_ / "runs/letters/recording.tsr"), "mine");
  EXPECT_EQ(content_of(folder_ / "elsewhere/recording.tsr"), "mine");
  in_use.reset();
  finished();
  finished();
  EXPECT_FALSE(fs::exists(used));
}

TEST_F(RunFolders, ARunThatHasNotBegunIsNotTheLast) {
  begin().withdraw();
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder_ / "last")));
  const fs::path good = finished();
  fs::path failed;
  {
    const RunFolder run = begin();
    failed = run.path();
    write(failed / "recording.tsr", "a header");
    EXPECT_EQ(fs::canonical(folder_ / "last"), failed);
    run.withdraw();
  }
  EXPECT_FALSE(fs::exists(failed));
  EXPECT_EQ(fs::canonical(folder_ / "last"), good);

  // Two at once: the second has seen the first, which is gone by then.
  const RunFolder first = begin(), second = begin();
  write(first.path() / "notes.txt", "mine");
  first.withdraw();
  EXPECT_EQ(fs::canonical(folder_ / "last"), second.path());
  EXPECT_EQ(content_of(first.path() / "notes.txt"), "mine");
  fs::remove_all(first.path());
  second.withdraw();
  EXPECT_EQ(fs::canonical(folder_ / "last"), good);
}

TEST_F(RunFolders, WhatLastShowsStays) {
  setenv("TESSERA_KEEP_RUNS", "2", 1);
  const fs::path shown = finished();
  std::set<fs::path> names{shown};
  for (int more = 0; more < 5; ++more) names.insert(begin(RunFolder::Shown::no).path());
  EXPECT_EQ(fs::canonical(folder_ / "last"), shown);
  EXPECT_EQ(names.size(), 6U);  // although most of them are gone
}

TEST_F(RunFolders, AreBoundBySizeToo) {
  setenv("TESSERA_KEEP_RUNS_SIZE", "1kB", 1);
  const fs::path first = finished(600), second = finished(300);
  const fs::path third = finished(300);
  EXPECT_TRUE(fs::exists(first));  // 1.2 kB by now: the next one sees it
  const fs::path fourth = finished(5000);
  EXPECT_FALSE(fs::exists(first));
  EXPECT_TRUE(fs::exists(second));
  const RunFolder run = begin();
  EXPECT_FALSE(fs::exists(third));
  EXPECT_TRUE(fs::exists(fourth));  // the newest stays
  setenv("TESSERA_KEEP_RUNS_SIZE", "much", 1);
  EXPECT_THROW(begin(), std::runtime_error);
}

TEST_F(RunFolders, AProgramStaysWhatItIsWhileOthersAreBuilt) {
  write("build/controller", "first");
  const fs::path first = project::keep_program(folder_, folder_ / "build/controller", "controller-release");
  EXPECT_EQ(project::keep_program(folder_, folder_ / "build/controller", "controller-release"), first);
  const RunFolder run = begin();
  const fs::path own = run.own_copy_of(first);
  write("build/next", "second");
  fs::rename(folder_ / "build/next", folder_ / "build/controller");  // as a linker does
  const fs::path second = project::keep_program(folder_, folder_ / "build/controller", "controller-release");
  EXPECT_NE(first, second);
  EXPECT_EQ(content_of(own), "first");
  EXPECT_EQ(content_of(second), "second");

  // An old folder without a run is removed. A folder with a run, or the newest, stays.
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(5);
  fs::last_write_time(first, long_ago);
  write("programs/controller-release-000000000000", "nobody's");
  fs::last_write_time(folder_ / "programs/controller-release-000000000000", long_ago);
  static_cast<void>(project::keep_program(folder_, folder_ / "build/controller", "controller-release"));
  EXPECT_TRUE(fs::exists(first));
  EXPECT_TRUE(fs::exists(second));
  EXPECT_FALSE(fs::exists(folder_ / "programs/controller-release-000000000000"));
}

TEST_F(RunFolders, TheBuildLockGoesWithItsHolderAndEndsWaitingWhenAsked) {
  Said said;
  auto held = project::take_build_lock(folder_, said, nullptr);
  ASSERT_TRUE(held);
  EXPECT_NE(content_of(folder_ / "build.lock").find("process " + std::to_string(getpid())),
            std::string::npos);
  std::atomic<bool> stop{false};
  std::optional<project::LockFile> other;
  std::thread waiting([&] { other = project::take_build_lock(folder_, said, &stop); });
  stop = true;
  waiting.join();
  EXPECT_FALSE(other);
  held.reset();
  EXPECT_TRUE(project::take_build_lock(folder_, said, nullptr));
}

}  // namespace
}  // namespace tessera::project_test

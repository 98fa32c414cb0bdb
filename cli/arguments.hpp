#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// What the commands take from the command line.
///
/// Only arguments.cpp includes CLI11: it is headers only, and each file that includes it compiles for ten
/// seconds.
namespace tessera::cli {

/// An option that a command has. Valid as long as the `CommandLine`.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required();
  /// The help shows the value that the variable has now.
  Option& shows_default();
  /// Any other value is a usage mistake.
  Option& one_of(const std::vector<std::string>& values);
  Option& existing_file();
  Option& positive();
  Option& within(int least, int most);
  /// May be given several times, with one value each.
  Option& repeated();
  /// Both together are a usage mistake.
  Option& excludes(Option other);

 private:
  CLI::Option* option_;
};

/// One command, such as `check`. Variables must live until it has run. Valid as long as the `CommandLine`.
class Subcommand {
 public:
  explicit Subcommand(CLI::App& app) : app_(&app) {}

  /// `names`: "--for", "-o,--output"; without dashes its place on the line counts: "spec".
  Option option(const std::string& names, std::string& value, const std::string& help);
  Option option(const std::string& names, std::vector<std::string>& value, const std::string& help);
  Option option(const std::string& names, double& value, const std::string& help);
  Option option(const std::string& names, std::uint64_t& value, const std::string& help);
  Option option(const std::string& names, unsigned& value, const std::string& help);
  Option option(const std::string& names, int& value, const std::string& help);
  Option flag(const std::string& names, bool& value, const std::string& help);
  /// A flag that may carry a value: --values, --values=TEXT. Without one it is `given`.
  Option flag(const std::string& name, std::string& value, const std::string& given, const std::string& help);
  /// One that was declared before. Throws where there is none.
  [[nodiscard]] Option declared(const std::string& name) const;
  /// Below the options in the help.
  void footer(const std::string& text);
  /// What it does. Exceptions come out of `CommandLine::read`.
  void callback(std::function<void()> command);

 private:
  CLI::App* app_;
};

/// The line that the program was started with. For one thread.
class CommandLine {
 public:
  CommandLine(const std::string& program, const std::string& version, const std::string& about);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  [[nodiscard]] Subcommand add(const std::string& name, const std::string& about);
  /// An option of every command. `value` names its value in the help.
  void option(const std::string& name, const std::string& value, const std::function<void(std::string)>& use,
              const std::string& help);
  void footer(const std::string& text);

  /// Reads the line and runs the command that it names. nothing: it has run. `ok`: help or the version was
  /// asked for and printed. `usage`: the line is wrong, which has been said on standard error.
  [[nodiscard]] std::optional<int> read(int argc, char** argv);

  struct Words {
    std::string command;
    std::vector<std::string> options;  ///< long names, without dashes
  };
  /// What can be typed, for completion.
  [[nodiscard]] std::vector<Words> words() const;

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace tessera::cli

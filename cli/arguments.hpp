#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// Command line arguments of the commands.
///
/// Only arguments.cpp includes CLI11: it is a header-only library, and each file that includes
/// it compiles for ten seconds.
namespace tessera::cli {

/// An option of a command. Valid as long as the `CommandLine`.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required();
  /// Shows the present value of the variable in the help.
  Option& shows_default();
  /// Makes any other value a usage mistake.
  Option& one_of(const std::vector<std::string>& values);
  Option& existing_file();
  Option& positive();
  Option& within(int least, int most);
  /// Allows the option several times, with one value each.
  Option& repeated();
  /// Makes it a usage mistake to give both.
  Option& excludes(Option other);
  /// Makes it a usage mistake to give it without the other.
  Option& needs(Option other);

 private:
  CLI::Option* option_;
};

/// One command, such as `check`. The variables of its options must live until it has run. Valid as
/// long as the `CommandLine`.
class Subcommand {
 public:
  /// The words behind a flag of a command, which are taken away before the rest is read.
  struct Words {
    std::string command, flag;
    std::optional<std::vector<std::string>>* words;
  };
  Subcommand(CLI::App& app, int& exit_code, std::vector<Words>& words)
      : app_(&app), exit_code_(&exit_code), words_(&words) {}

  /// names: "--for", "-o,--output". A name without dashes, such as "spec", is a positional argument.
  Option option(const std::string& names, std::string& value, const std::string& help);
  Option option(const std::string& names, std::vector<std::string>& value, const std::string& help);
  Option option(const std::string& names, double& value, const std::string& help);
  Option option(const std::string& names, std::uint64_t& value, const std::string& help);
  Option option(const std::string& names, unsigned& value, const std::string& help);
  Option option(const std::string& names, int& value, const std::string& help);
  Option flag(const std::string& names, bool& value, const std::string& help);
  /// A flag that may have a value: --values, --values=TEXT. Without a value it is `given`.
  Option flag(const std::string& name, std::string& value, const std::string& given, const std::string& help);
  /// An option that may stand without a value, which is then empty: --explain, --explain NAME. nullopt: not given.
  Option optional_value(const std::string& name, std::optional<std::string>& value, const std::string& help);
  /// A flag whose words go from it to `--`, or to the end of the line, whatever they are. Without the flag, nullopt.
  void words(const std::string& flag, std::optional<std::vector<std::string>>& words,
             const std::string& help);
  /// An option that was declared before. Throws if there is none.
  [[nodiscard]] Option declared(const std::string& name) const;
  /// Text below the options in the help.
  void footer(const std::string& text);
  /// The function that the command runs. `CommandLine::read` returns its result, and passes its exceptions on.
  void runs(std::function<int()> command);
  /// The same for a function of options. Returns the options, for their declaration.
  template <class Options>
  auto& runs(int (*command)(Options)) {
    auto options = std::make_shared<std::remove_cvref_t<Options>>();
    runs([options, command] { return command(*options); });
    return *options;
  }

 private:
  CLI::App* app_;
  int* exit_code_;
  std::vector<Words>* words_;
};

/// The command line of the program. For one thread.
class CommandLine {
 public:
  CommandLine(const std::string& program, const std::string& version, const std::string& about);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  [[nodiscard]] Subcommand add(const std::string& name, const std::string& about);
  /// Adds an option to every command. `value` names its value in the help.
  void option(const std::string& name, const std::string& value, const std::function<void(std::string)>& use,
              const std::string& help);
  void footer(const std::string& text);

  /// Reads the line and runs the command that it names. The exit code: that of the command; `ok`: help or version
  /// was requested and printed; `usage`: the line is wrong, and standard error says why.
  [[nodiscard]] int read(int argc, char** argv);

  struct Word {
    std::string name;  ///< without dashes
    bool takes_value = false;
    std::vector<std::string> values;  ///< the only allowed ones; empty: any
  };
  struct Words {
    std::string command;
    std::vector<Word> options;        ///< with long names
    std::vector<std::string> values;  ///< the only allowed values of the first argument; empty: any
    std::size_t spec = 0;             ///< the position of the argument that names the specification
  };
  /// All words that can be typed, for completion.
  [[nodiscard]] std::vector<Words> words() const;

  /// A command that is not shown in the help. It gets the words after its name unchanged.
  void add_hidden(const std::string& name, std::function<void(std::vector<std::string>)> run);

 private:
  /// Takes the words of such flags away.
  [[nodiscard]] std::vector<char*> without_taken(int argc, char** argv) const;
  /// nullopt: it is a command, or it does not exist.
  [[nodiscard]] std::optional<int> unknown_command(int argc, char** argv) const;
  void tell_unexpected() const;

  std::unique_ptr<CLI::App> app_;
  int exit_code_ = 0;
  std::vector<Subcommand::Words> taken_;
  std::map<std::string, std::function<void(std::vector<std::string>)>> hidden_;
};

}  // namespace tessera::cli

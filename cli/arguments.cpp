#include "cli/arguments.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include "cli/terminal.hpp"
#include "tessera/nearest.hpp"

namespace tessera::cli {

namespace {

/// Names the form that a value of that type must have.
template <class Number>
CLI::Option& checked(CLI::Option& option) {
  option.check([](const std::string& text) -> std::string {
    Number number{};
    if (CLI::detail::lexical_cast(text, number)) return {};
    if (std::is_floating_point_v<Number>) return fmt::format("'{}' is no number", text);
    return fmt::format("'{}' is no whole number from {} to {}", text, std::numeric_limits<Number>::min(),
                       std::numeric_limits<Number>::max());
  });
  return option;
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::shows_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& values) {
  option_->check(CLI::IsMember(values));
  return *this;
}

Option& Option::existing_file() {
  option_->check(CLI::ExistingFile);
  return *this;
}

Option& Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option& Option::within(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::repeated() {
  option_->take_all()->allow_extra_args(false);
  return *this;
}

Option& Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

Option Subcommand::option(const std::string& names, std::string& value, const std::string& help) {
  return Option(*app_->add_option(names, value, help));
}

Option Subcommand::option(const std::string& names, std::vector<std::string>& value,
                          const std::string& help) {
  return Option(*app_->add_option(names, value, help));
}

Option Subcommand::option(const std::string& names, double& value, const std::string& help) {
  return Option(checked<double>(*app_->add_option(names, value, help)));
}

Option Subcommand::option(const std::string& names, std::uint64_t& value, const std::string& help) {
  return Option(checked<std::uint64_t>(*app_->add_option(names, value, help)));
}

Option Subcommand::option(const std::string& names, unsigned& value, const std::string& help) {
  return Option(checked<unsigned>(*app_->add_option(names, value, help)));
}

Option Subcommand::option(const std::string& names, int& value, const std::string& help) {
  return Option(checked<int>(*app_->add_option(names, value, help)));
}

Option Subcommand::flag(const std::string& names, bool& value, const std::string& help) {
  return Option(*app_->add_flag(names, value, help));
}

Option Subcommand::flag(const std::string& name, std::string& value, const std::string& given,
                        const std::string& help) {
  return Option(*app_->add_flag(name + "{" + given + "}", value, help));
}

Option Subcommand::optional_value(const std::string& name, std::optional<std::string>& value,
                                  const std::string& help) {
  const auto take = [&value](const CLI::results_t& given) {
    // CLI11 gives one of these for an option without a value.
    const bool is_missing = given.empty() || given.front() == "true" || given.front() == "{}";
    value = is_missing ? std::string() : given.front();
    return true;
  };
  return Option(*app_->add_option(name, take, help)->expected(0, 1)->type_name("[TEXT]"));
}

void Subcommand::words(const std::string& flag, std::optional<std::vector<std::string>>& words,
                       const std::string& help) {
  app_->add_flag(flag, help);
  words_->push_back({app_->get_name(), flag, &words});
}

Option Subcommand::declared(const std::string& name) const { return Option(*app_->get_option(name)); }

void Subcommand::footer(const std::string& text) { app_->footer(text); }

void Subcommand::runs(std::function<int()> command) {
  app_->callback([command = std::move(command), code = exit_code_] { *code = command(); });
}

CommandLine::CommandLine(const std::string& program, const std::string& version, const std::string& about)
    : app_(std::make_unique<CLI::App>(about)) {
  app_->name(program);
  app_->set_version_flag("--version", version);
  app_->require_subcommand(1);
  app_->fallthrough();
}

CommandLine::~CommandLine() = default;

Subcommand CommandLine::add(const std::string& name, const std::string& about) {
  return {*app_->add_subcommand(name, about), exit_code_, taken_};
}

void CommandLine::option(const std::string& name, const std::string& value,
                         const std::function<void(std::string)>& use, const std::string& help) {
  app_->add_option_function<std::string>(name, use, help)->option_text(value);
}

void CommandLine::footer(const std::string& text) { app_->footer(text); }

void CommandLine::add_hidden(const std::string& name, std::function<void(std::vector<std::string>)> run) {
  hidden_[name] = std::move(run);
}

namespace {

/// "robot" in "TEXT:{robot,arm}": the allowed values, as the help shows them.
std::vector<std::string> allowed_values(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.rfind('}');
  std::vector<std::string> values;
  if (begin == std::string::npos || end == std::string::npos || end < begin) return values;
  std::istringstream words(type.substr(begin + 1, end - begin - 1));
  for (std::string word; std::getline(words, word, ',');) values.push_back(word);
  return values;
}

}  // namespace

std::optional<int> CommandLine::unknown_command(int argc, char** argv) const {
  std::vector<std::string> commands;
  for (const CLI::App* command : app_->get_subcommands({})) commands.push_back(command->get_name());
  for (int at = 1; at < argc; ++at) {
    const std::string word = argv[at];
    if (word == "--state") {
      ++at;
    } else if (!word.starts_with('-')) {
      if (std::find(commands.begin(), commands.end(), word) != commands.end()) return std::nullopt;
      complain(with_hint("there is no command '" + word + "'", did_you_mean(word, commands)));
      fmt::print(stderr, "`tessera --help` lists the commands\n");
      return usage;
    }
  }
  return std::nullopt;
}

void CommandLine::tell_unexpected() const {
  std::string command = "tessera";
  std::vector<std::string> options{"--help", "--version", "--state"};
  // For these options, the option with the nearest spelling would mislead.
  static const std::map<std::string, std::string> moved_options{{"--schedules", "schedules N"},
                                                                {"--steps", "play NET"}};
  for (const CLI::App* chosen : app_->get_subcommands()) {
    command += " " + chosen->get_name();
    for (const CLI::Option* option : chosen->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  for (const std::string& word : app_->remaining(true)) {
    const std::string name = word.substr(0, word.find('='));
    if (const auto moved = moved_options.find(name);
        command == "tessera simulate" && moved != moved_options.end())
      complain(fmt::format("{} has no option '{}': use `tessera {}`", command, name, moved->second));
    else if (word.starts_with('-'))
      complain(with_hint(fmt::format("{} has no option '{}'", command, name), did_you_mean(name, options)));
    else
      complain(fmt::format("{} does not expect '{}'", command, word));
  }
  fmt::print(stderr, "`{} --help` shows its options\n", command);
}

std::vector<char*> CommandLine::without_taken(int argc, char** argv) const {
  std::vector<char*> left;
  const Subcommand::Words* within = nullptr;
  for (char** at = argv; at != argv + argc; ++at) {
    const std::string_view word = *at;
    const auto begins = std::find_if(taken_.begin(), taken_.end(), [&](const Subcommand::Words& one) {
      return word == one.flag && std::find(left.begin(), left.end(), one.command) != left.end();
    });
    if (within == nullptr && begins != taken_.end()) {
      within = &*begins;
      if (!*within->words) within->words->emplace();
    } else if (within != nullptr && word == "--") {
      within = nullptr;
    } else if (within != nullptr) {
      (*within->words)->emplace_back(word);
    } else {
      left.push_back(*at);
    }
  }
  return left;
}

int CommandLine::read(int argc, char** argv) {
  if (argc > 1)
    if (const auto hidden = hidden_.find(argv[1]); hidden != hidden_.end()) {
      hidden->second({argv + 2, argv + argc});
      return ok;
    }
  if (const std::optional<int> wrong = unknown_command(argc, argv)) return *wrong;
  try {
    std::vector<char*> left = without_taken(argc, argv);
    app_->parse(static_cast<int>(left.size()), left.data());
    return exit_code_;
  } catch (const CLI::ExtrasError&) {
    tell_unexpected();
    return usage;
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? ok : usage;
  }
}

std::vector<CommandLine::Words> CommandLine::words() const {
  std::vector<Words> all;
  for (const CLI::App* command : app_->get_subcommands({})) {
    Words words{command->get_name(), {}, {}, 0};
    std::size_t arguments = 0;
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames())
        words.options.push_back({name, option->get_items_expected_max() > 0, allowed_values(*option)});
      if (!option->get_positional()) continue;
      if (words.values.empty()) words.values = allowed_values(*option);
      if (option->get_name(/*positional=*/true) == "spec") words.spec = arguments;
      ++arguments;
    }
    all.push_back(std::move(words));
  }
  return all;
}

}  // namespace tessera::cli

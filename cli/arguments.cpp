#include "cli/arguments.hpp"

#include <CLI/CLI.hpp>
#include <utility>

#include "cli/terminal.hpp"

namespace tessera::cli {

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
  return Option(*app_->add_option(names, value, help));
}

Option Subcommand::option(const std::string& names, std::uint64_t& value, const std::string& help) {
  return Option(*app_->add_option(names, value, help));
}

Option Subcommand::option(const std::string& names, unsigned& value, const std::string& help) {
  return Option(*app_->add_option(names, value, help));
}

Option Subcommand::option(const std::string& names, int& value, const std::string& help) {
  return Option(*app_->add_option(names, value, help));
}

Option Subcommand::flag(const std::string& names, bool& value, const std::string& help) {
  return Option(*app_->add_flag(names, value, help));
}

Option Subcommand::flag(const std::string& name, std::string& value, const std::string& given,
                        const std::string& help) {
  return Option(*app_->add_flag(name + "{" + given + "}", value, help));
}

Option Subcommand::declared(const std::string& name) const { return Option(*app_->get_option(name)); }

void Subcommand::footer(const std::string& text) { app_->footer(text); }

void Subcommand::callback(std::function<void()> command) { app_->callback(std::move(command)); }

CommandLine::CommandLine(const std::string& program, const std::string& version, const std::string& about)
    : app_(std::make_unique<CLI::App>(about)) {
  app_->name(program);
  app_->set_version_flag("--version", version);
  app_->require_subcommand(1);
  app_->fallthrough();
}

CommandLine::~CommandLine() = default;

Subcommand CommandLine::add(const std::string& name, const std::string& about) {
  return Subcommand(*app_->add_subcommand(name, about));
}

void CommandLine::option(const std::string& name, const std::string& value,
                         const std::function<void(std::string)>& use, const std::string& help) {
  app_->add_option_function<std::string>(name, use, help)->option_text(value);
}

void CommandLine::footer(const std::string& text) { app_->footer(text); }

std::optional<int> CommandLine::read(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? ok : usage;
  }
}

std::vector<CommandLine::Words> CommandLine::words() const {
  std::vector<Words> all;
  for (const CLI::App* command : app_->get_subcommands({})) {
    Words words{command->get_name(), {}};
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) words.options.push_back(name);
    all.push_back(std::move(words));
  }
  return all;
}

}  // namespace tessera::cli

// The command `tessera` as a black box: files in, files and exit codes out.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "oracle/judge/flat_net.hpp"

namespace oracle {

struct Answer {
  int exit = -1;
  std::string output, errors;
};

class Command {
 public:
  /// `program` is the command; files are written under `folder`, which must exist.
  Command(std::string program, std::string folder)
      : program_(std::move(program)), folder_(std::move(folder)) {}

  Answer run(const std::vector<std::string>& arguments) const;
  const std::string& folder() const { return folder_; }

 private:
  std::string program_, folder_;
};

std::string read_text(const std::string& path);
void write_text(const std::string& path, const std::string& text);

/// A place/transition net as PNML names it. Transitions: name, sorted names of their input and output places.
struct NamedNet {
  std::map<std::string, bool> places;  // name -> marked at the beginning
  struct Arcs {
    std::multiset<std::string> takes, gives;
    friend auto operator<=>(const Arcs&, const Arcs&) = default;
  };
  std::multimap<std::string, Arcs> transitions;
};
NamedNet read_pnml(const std::string& text);
NamedNet named(const FlatNet& net);

}  // namespace oracle

#include "command.hpp"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <pugixml.hpp>
#include <sstream>

namespace oracle {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

std::string name_of(const pugi::xml_node& node) { return node.child("name").child("text").text().get(); }

}  // namespace

Answer Command::run(const std::vector<std::string>& arguments) const {
  const std::string out = folder_ + "/out.txt", err = folder_ + "/err.txt";
  std::string line = quoted(program_);
  for (const std::string& argument : arguments) line += " " + quoted(argument);
  line += " >" + quoted(out) + " 2>" + quoted(err) + " </dev/null";
  const int status = std::system(line.c_str());
  Answer answer;
  answer.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  answer.output = read_text(out);
  answer.errors = read_text(err);
  return answer;
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

NamedNet read_pnml(const std::string& text) {
  NamedNet net;
  pugi::xml_document document;
  if (!document.load_string(text.c_str())) return net;
  const auto root = document.child("pnml").child("net");
  std::map<std::string, std::string> place;
  std::map<std::string, NamedNet::Arcs> arcs;
  const auto pages = root.children("page");
  for (const auto& page : pages) {
    for (const auto& node : page.children("place")) {
      place[node.attribute("id").value()] = name_of(node);
      const std::string tokens = node.child("initialMarking").child("text").text().get();
      net.places[name_of(node)] = !tokens.empty() && tokens != "0";
    }
    for (const auto& node : page.children("arc")) {
      const std::string from = node.attribute("source").value(), to = node.attribute("target").value();
      if (place.contains(from))
        arcs[to].takes.insert(place[from]);
      else
        arcs[from].gives.insert(place[to]);
    }
    for (const auto& node : page.children("transition"))
      net.transitions.emplace(name_of(node), arcs[node.attribute("id").value()]);
  }
  return net;
}

NamedNet named(const FlatNet& net) {
  NamedNet result;
  for (const auto& place : net.places) result.places[place.name] = place.marked;
  for (const auto& transition : net.transitions) {
    NamedNet::Arcs arcs;
    for (const int p : transition.pre) arcs.takes.insert(net.places[static_cast<std::size_t>(p)].name);
    for (const int p : transition.post) arcs.gives.insert(net.places[static_cast<std::size_t>(p)].name);
    result.transitions.emplace(transition.name, arcs);
  }
  return result;
}

}  // namespace oracle

#include "compare.hpp"

#include <algorithm>

#include "counterexample.hpp"
#include "oracle/judge/conditions.hpp"

namespace oracle {
namespace {

using nlohmann::json;

constexpr std::size_t most_places = 300;

class Comparer {
 public:
  Comparer(const Specification& specification, const Command& command, std::size_t limit)
      : specification_(specification),
        command_(command),
        limit_(limit),
        flat_(flat_net(specification)),
        file_(command.folder() + "/spec.yaml") {}

  Comparison run() {
    write_text(file_, to_yaml(specification_));
    const FlatNet normal = abstract_net(flat_, false);
    if (normal.places.size() > most_places) return too_large();
    const bool sound = std::all_of(specification_.models.begin(), specification_.models.end(), sound_model);
    std::optional<Judge> judge;
    if (sound) judge.emplace(normal, limit_);
    if (sound && !judge->graph().complete()) return too_large();
    const Judge exceptional(sound ? abstract_net(flat_, true)
                                  : FlatNet{{{"in", true, false}}, {}, {}, {}, {}, {}, {}, {}, {}, -1},
                            limit_);
    if (!exceptional.graph().complete()) return too_large();
    const Answer answer =
        command_.run({"verify", file_, "--json", command_.folder() + "/verdicts.json", "--timeout", "60s"});
    const std::string text = answer.exit == 0 || answer.exit == 1 || answer.exit == 3
                                 ? read_text(command_.folder() + "/verdicts.json")
                                 : "";
    write_text(command_.folder() + "/verdicts.json", "");
    if (text.empty() && answer.exit != 0 && answer.errors.find("error E") == std::string::npos)
      differ("crash", "exit " + std::to_string(answer.exit));
    if (text.empty()) return refused(answer, sound);
    if (!sound) differ("accepted", "an unsound communication model");
    if (!sound) return result_;
    nets();
    verdicts(json::parse(text), *judge, exceptional);
    result_.states = judge->graph().size();
    return result_;
  }

 private:
  void differ(const std::string& kind, const std::string& detail) {
    result_.disagreements.push_back({kind, detail});
  }
  Comparison too_large() {
    result_.too_large = true;
    return result_;
  }

  /// A refusal has to be one that the documentation explains.
  Comparison refused(const Answer& answer, bool sound) {
    result_.refused = true;
    const std::size_t at = answer.errors.find("error E");
    result_.refusal =
        at == std::string::npos ? "exit " + std::to_string(answer.exit) : answer.errors.substr(at + 6, 4);
    bool explained = false;
    if (result_.refusal == "E305")
      explained = std::any_of(flat_.behaviours.begin(), flat_.behaviours.end(), [&](const auto& behaviour) {
        return !behaviour.of->is_group && !behaviour.waits && !behaviour.of->takes &&
               !flat_.subsystems[static_cast<std::size_t>(behaviour.subsystem)].of->rate;
      });
    if (result_.refusal.starts_with("E43")) explained = !sound;
    if (result_.refusal == "E303")
      explained = std::any_of(
          specification_.properties.begin(), specification_.properties.end(),
          [&](const Property& property) { return compile(specification_, flat_, property).empty(); });
    if (!explained)
      differ("refused " + result_.refusal, answer.errors.substr(at == std::string::npos ? 0 : at, 200));
    return result_;
  }

  void nets() {
    const NamedNet mine = named(flat_);
    const NamedNet exported = read_pnml(command_.run({"export", file_, "--pnml", "-"}).output);
    if (exported.places != mine.places) differ("net places", different(mine.places, exported.places));
    if (exported.transitions != mine.transitions)
      differ("net transitions", different_transitions(mine, exported));
    counts();
    abstract(named(abstract_net(flat_, false)));
    ++result_.nets;
  }

  static std::string different(const std::map<std::string, bool>& mine,
                               const std::map<std::string, bool>& exported) {
    std::string text;
    for (const auto& [name, marked] : mine)
      if (!exported.contains(name) || exported.at(name) != marked) text += "only the oracle: " + name + "\n";
    for (const auto& [name, marked] : exported)
      if (!mine.contains(name) || mine.at(name) != marked) text += "only the export: " + name + "\n";
    return text;
  }
  static std::string different_transitions(const NamedNet& mine, const NamedNet& exported) {
    std::string text;
    for (const auto& one : mine.transitions)
      if (std::find(exported.transitions.begin(), exported.transitions.end(), one) ==
          exported.transitions.end())
        text += "only the oracle: " + one.first + "\n";
    for (const auto& one : exported.transitions)
      if (std::find(mine.transitions.begin(), mine.transitions.end(), one) == mine.transitions.end())
        text += "only the export: " + one.first + "\n";
    return text;
  }

  /// Transitions behind the end of a behaviour that cannot end may be left out or not.
  void abstract(NamedNet mine) {
    NamedNet exported = read_pnml(command_.run({"export", file_, "--abstract", "--pnml", "-"}).output);
    for (std::size_t b = 0; b < flat_.behaviours.size(); ++b) {
      const auto& behaviour = flat_.behaviours[b];
      if (can_end(flat_, static_cast<int>(b), false)) continue;
      const std::string out = behaviour.path + ".out";
      std::erase_if(exported.transitions, [&](const auto& one) {
        return one.second.takes.contains(out) && !one.first.ends_with(".t_out");
      });
      std::erase_if(exported.places, [&](const auto& one) { return one.first.starts_with(out + ".none"); });
    }
    if (exported.places != mine.places) differ("abstract places", different(mine.places, exported.places));
    if (exported.transitions != mine.transitions)
      differ("abstract transitions", different_transitions(mine, exported));
  }

  void counts() {
    const json shown =
        json::parse(command_.run({"show", file_, "--counts", "--json", "-"}).output, nullptr, false);
    if (shown.is_discarded()) return differ("counts", "no JSON");
    std::string text;
    for (const auto& [layer, counts] : flat_.layers) {
      const json& of = shown.at("layers").at(layer);
      if (of.at("places") != counts.places || of.at("transitions") != counts.transitions ||
          of.at("pages") != counts.pages)
        text += layer + " ";
    }
    std::size_t arcs = 0, fused = 0;
    for (const auto& transition : flat_.transitions) arcs += transition.pre.size() + transition.post.size();
    for (const auto& place : flat_.places) fused += place.fused ? 1 : 0;
    const json& flat = shown.at("flat");
    if (flat.at("places") != flat_.places.size() || flat.at("transitions") != flat_.transitions.size() ||
        flat.at("arcs") != arcs || flat.at("fused") != fused)
      text += "flat";
    if (!text.empty()) differ("counts", text);
  }

  void verdicts(const json& answer, const Judge& judge, const Judge& exceptional) {
    static const std::vector<std::string> names{
        "safe",          "exclusive_channels", "deadlock_free",   "goes_on",
        "channels_flow", "sound_pages",        "live_behaviours", "survives_exceptions"};
    const json& properties = answer.at("properties");
    if (properties.size() != names.size() + specification_.properties.size())
      return differ("properties", "another number of them");
    for (std::size_t p = 0; p < properties.size(); ++p) {
      const std::string name = properties[p].at("name");
      if (p < names.size()) {
        const bool exceptions = name == "survives_exceptions";
        if (name != names[p]) differ("properties", "unexpected " + name);
        one(properties[p], default_holds(name, judge, exceptional),
            {specification_, exceptions ? exceptional : judge, exceptions, nullptr}, name);
      } else {
        const Property& property = specification_.properties[p - names.size()];
        one(properties[p], judge.holds(specification_, property), {specification_, judge, false, &property},
            kind_name(property.kind));
      }
    }
    const json& live = properties[6];
    const bool dead = live.at("verdict") == "violated";  // else: they run, but only after a failure
    for (const std::string& path : dead ? exceptional.dead_behaviours() : judge.dead_behaviours())
      if (live.at("verdict") != "unknown" &&
          live.at("why").get<std::string>().find(path) == std::string::npos)
        differ("live_behaviours incomplete", path + " is not named");
  }

  static bool default_holds(const std::string& name, const Judge& judge, const Judge& exceptional) {
    if (name == "safe") return judge.graph().safe();
    if (name == "exclusive_channels") return judge.exclusive_channels();
    if (name == "deadlock_free") return judge.deadlock_free();
    if (name == "goes_on") return judge.goes_on();
    if (name == "channels_flow") return judge.channels_flow();
    if (name == "sound_pages") return judge.sound_pages();
    if (name == "live_behaviours") return exceptional.dead_behaviours().empty();
    return exceptional.deadlock_free() && exceptional.goes_on();
  }

  void one(const json& verdict, bool holds, const Shown& shown, const std::string& kind) {
    const std::string said = verdict.at("verdict");
    if (said == "unknown") {
      ++result_.unknown;
      return differ("unknown " + kind, verdict.at("why"));
    }
    ++result_.verdicts;
    result_.violated += said == "violated" ? 1 : 0;
    const std::string label = verdict.at("name").get<std::string>() + " (" + kind + ")";
    if ((said == "holds") != holds)
      return differ("verdict " + kind,
                    label + ": the command says " + said + "; why: " + verdict.at("why").get<std::string>());
    if (said != "violated") return;
    if (verdict.at("trace").is_null()) {
      ++result_.without_run;
      return;
    }
    ++result_.runs;
    for (const std::string& complaint : check_run(shown, verdict))
      differ("run " + kind + " " + complaint.substr(0, complaint.find(':')), label + ": " + complaint);
  }

  const Specification& specification_;
  const Command& command_;
  std::size_t limit_;
  FlatNet flat_;
  std::string file_;
  Comparison result_;
};

}  // namespace

Comparison compare(const Specification& specification, const Command& command, std::size_t limit) {
  return Comparer(specification, command, limit).run();
}

}  // namespace oracle

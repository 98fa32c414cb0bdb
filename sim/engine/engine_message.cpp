#include "sim/engine/engine_message.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <string_view>

namespace tessera::sim {
namespace {

/// Elements and sections that came after MuJoCo 2.2.2.
constexpr auto newer_elements = std::to_array<std::string_view>({"attach",
                                                                 "replicate",
                                                                 "frame",
                                                                 "plugin",
                                                                 "extension",
                                                                 "instance",
                                                                 "flex",
                                                                 "flexcomp",
                                                                 "deformable",
                                                                 "flexvert",
                                                                 "flexstrain",
                                                                 "edge",
                                                                 "elasticity",
                                                                 "model",
                                                                 "distance",
                                                                 "normal",
                                                                 "fromto",
                                                                 "contact",
                                                                 "camprojection",
                                                                 "insidesite",
                                                                 "jointactuatorfrc",
                                                                 "tendonactuatorfrc",
                                                                 "e_potential",
                                                                 "e_kinetic",
                                                                 "tactile",
                                                                 "layer",
                                                                 "config",
                                                                 "dcmotor"});

struct NewerAttribute {
  std::string_view element;  ///< empty: any
  std::string_view attribute;
};

constexpr std::array newer_attributes = std::to_array<NewerAttribute>({
    {"position", "kv"},
    {"position", "dampratio"},
    {"", "inheritrange"},
    {"", "timeconst"},
    {"", "actdim"},
    {"", "actearly"},
    {"", "actlimited"},
    {"", "actrange"},
    {"", "tausmooth"},
    {"", "damping"},
    {"", "armature"},
    {"", "delay"},
    {"", "nsample"},
    {"", "interval"},
    {"", "actuatorfrcrange"},
    {"", "actuatorfrclimited"},
    {"", "actuatorgravcomp"},
    {"", "gravcomp"},
    {"body", "sleep"},
    {"freejoint", "align"},
    {"freejoint", "springdamper"},
    {"camera", "resolution"},
    {"camera", "focal"},
    {"camera", "focalpixel"},
    {"camera", "principal"},
    {"camera", "principalpixel"},
    {"camera", "sensorsize"},
    {"camera", "orthographic"},
    {"camera", "projection"},
    {"camera", "output"},
    {"light", "bulbradius"},
    {"light", "intensity"},
    {"light", "range"},
    {"light", "type"},
    {"light", "texture"},
    {"mesh", "inertia"},
    {"mesh", "maxhullvert"},
    {"mesh", "content_type"},
    {"mesh", "builtin"},
    {"mesh", "params"},
    {"mesh", "material"},
    {"texture", "content_type"},
    {"texture", "colorspace"},
    {"texture", "nchannel"},
    {"hfield", "content_type"},
    {"hfield", "elevation"},
    {"material", "metallic"},
    {"material", "roughness"},
    {"compiler", "assetdir"},
    {"compiler", "alignfree"},
    {"compiler", "saveinertial"},
    {"compiler", "conflict"},
    {"size", "memory"},
    {"option", "ls_iterations"},
    {"option", "ls_tolerance"},
    {"option", "ccd_iterations"},
    {"option", "ccd_tolerance"},
    {"option", "sdf_iterations"},
    {"option", "sdf_initpoints"},
    {"option", "sleep_tolerance"},
    {"option", "o_friction"},
    {"option", "actuatorgroupdisable"},
    {"flag", "eulerdamp"},
    {"flag", "island"},
    {"flag", "nativeccd"},
    {"flag", "midphase"},
    {"flag", "invdiscrete"},
    {"flag", "autoreset"},
    {"flag", "sleep"},
    {"flag", "spring"},
    {"flag", "damper"},
    {"global", "ellipsoidinertia"},
    {"global", "bvactive"},
    {"global", "cameraid"},
    {"global", "orthographic"},
    {"global", "realtime"},
    {"", "springinertia"},
    {"tendon", "armature"},
    {"weld", "site1"},
    {"weld", "site2"},
    {"connect", "site1"},
    {"connect", "site2"},
    {"composite", "curve"},
    {"composite", "initial"},
    {"composite", "size"},
    {"composite", "quat"},
    {"rangefinder", "camera"},
    {"rangefinder", "data"},
    {"pair", "solreffriction"},
});

/// Values of attributes.
constexpr auto newer_keywords =
    std::to_array<std::string_view>({"implicitfast", "filterexact", "cable", "sdf", "convex", "exact",
                                     "legacy", "shell", "auto", "dcmotor", "spot", "orthographic"});

std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c != '\n') {
      line += c;
    } else if (!line.empty() && line.back() != ' ') {
      if (line.back() != ':' && line.back() != ',') line += ',';
      line += ' ';
    }
  }
  while (!line.empty() && (line.back() == ' ' || line.back() == ',')) line.pop_back();
  return line;
}

/// The position that the engine reports: "Element 'position', line 2, column 5".
struct Where {
  std::string element, line;
};

Where where_in(const std::string& message) {
  static const std::regex place("Element '([^']*)', line ([0-9]+)");
  std::smatch found;
  if (!std::regex_search(message, found, place)) return {};
  // The engine does not know the line inside an included file.
  return {found[1], found[2] == "0" ? "" : " (line " + found[2].str() + ")"};
}

bool is_newer_attribute(std::string_view element, std::string_view attribute) {
  return std::ranges::any_of(newer_attributes, [&](const NewerAttribute& known) {
    return known.attribute == attribute && (known.element.empty() || known.element == element);
  });
}

std::string unknown(const std::string& what, const Where& where, bool is_newer) {
  if (is_newer) return "needs a newer MuJoCo: " + what + where.line;
  return "MuJoCo 2.2.2 does not know " + what + " at this place" + where.line +
         "; it is wrong, or needs a newer MuJoCo";
}

}  // namespace

std::string explained(const std::string& engine_message) {
  static const std::regex missing("required attribute missing: '([^']*)'");
  static const std::regex attribute("unrecognized attribute: '([^']*)'");
  static const std::regex keyword("invalid keyword: '([^']*)'");
  static const std::regex no_include("XML_ERROR_FILE_NOT_FOUND.*filename=([^,']*)");
  static const std::regex bad_include("Include error.*Error=XML_ERROR_([A-Z_]*) .*Line number=([0-9]+)");
  static const std::regex no_file("could not open (?:[A-Z]+ )?file '([^']*)'.*line = ([0-9]+)");
  const Where where = where_in(engine_message);
  const std::string line = on_one_line(engine_message);
  std::smatch found;
  if (std::regex_search(line, found, no_include)) {
    std::string file = found[1].str();
    file.erase(file.find_last_not_of(' ') + 1);
    return "there is no file " + file + ", which an <include> names" + where.line;
  }
  if (std::regex_search(line, found, bad_include))
    return "the file of an <include>" + where.line + " is no well-formed XML: in its line " + found[2].str();
  if (std::regex_search(line, found, no_file))
    return "the file " + found[1].str() + " cannot be opened (line " + found[2].str() + ")";
  if (engine_message.find("model type: 'mujocoinclude'") != std::string::npos)
    return "is a part for an <include>, no model of its own: open the file that includes it";
  if (engine_message.find("stateless actuators must come before") != std::string::npos)
    return "MuJoCo 2.2.2 wants actuators with an activation (`muscle`, `cylinder`, `dyntype`) behind all "
           "others; "
           "sort them, or use a newer MuJoCo, which takes any order";
  if (where.element.empty()) return on_one_line(engine_message);
  if (std::regex_search(engine_message, found, attribute))
    return unknown("`" + found[1].str() + "` of `" + where.element + "`", where,
                   is_newer_attribute(where.element, found[1].str()));
  // The engine checks the attribute before the class.
  if (where.element == "adhesion" && std::regex_search(engine_message, found, missing) &&
      found[1] == "ctrlrange")
    return "MuJoCo 2.2.2 wants `ctrlrange` at `adhesion` itself" + where.line +
           ", not in a default class; write it there, or use a newer MuJoCo, which takes both";
  if (std::regex_search(engine_message, found, keyword))
    return unknown("`" + found[1].str() + "` in `" + where.element + "`", where,
                   std::ranges::find(newer_keywords, found[1].str()) != newer_keywords.end());
  if (engine_message.find("unrecognized element") != std::string::npos)
    return unknown("`" + where.element + "`", where,
                   std::ranges::find(newer_elements, where.element) != newer_elements.end());
  return on_one_line(engine_message);
}

}  // namespace tessera::sim

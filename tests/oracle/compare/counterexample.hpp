// The runs that the command shows: legal, and ending in what they are said to show.
#pragma once

#include <nlohmann/json.hpp>

#include "oracle/judge/judge.hpp"

namespace oracle {

/// What a run may be wrong about: one sentence each, beginning with a word for its kind.
using Complaints = std::vector<std::string>;

struct Shown {
  const Specification& specification;
  const Judge& judge;  // of the net that the property speaks of
  bool exceptions = false;
  const Property* property = nullptr;  // null: a default property
};

/// `verdict` is one of `properties[]` of `tessera verify --json`, violated and with a run.
Complaints check_run(const Shown& shown, const nlohmann::json& verdict);

}  // namespace oracle

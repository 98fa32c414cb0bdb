// The runs that the command shows: they are legal, and end in the state that they claim to show.
#pragma once

#include <nlohmann/json.hpp>

#include "oracle/judge/judge.hpp"

namespace oracle {

/// The possible mistakes of a run: one sentence each, beginning with a word for its kind.
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

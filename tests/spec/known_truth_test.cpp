#include "spec/conditions/known_truth.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tessera::spec {
namespace {

/// A part "t" is always true, "f" never, everything else is free.
Truth of(const std::string& expression) {
  return truth_of(expression, [](std::span<const Token> part) {
    if (part.size() == 1 && part.front().is("t")) return Truth::always;
    return part.size() == 1 && part.front().is("f") ? Truth::never : Truth::free;
  });
}

TEST(KnownTruth, ConjunctionsDisjunctionsAndNegationsAreDecidedByTheirPartsAsFarAsThatGoes) {
  struct Case {
    const char* expression;
    Truth truth;
  };
  constexpr Truth yes = Truth::always, no = Truth::never, open = Truth::free;
  const std::vector<Case> cases{
      {"t", yes},
      {"f", no},
      {"x", open},
      {"true", yes},
      {"false", no},
      {"!t", no},
      {"not f", yes},
      {"!!t", yes},
      {"!x", open},
      {"t && x", open},
      {"f && x", no},
      {"x and f", no},
      {"t || x", yes},
      {"x or t", yes},
      {"f || x", open},
      {"f || f && t", no},
      {"f && t || t", yes},
      {"f && (t || t)", no},
      {"!(t && f) && t", yes},
      {"((t))", yes},
      {"(t) && (f || t)", yes},
      // Parts that only look like one: the operators bind otherwise.
      {"!t == x", open},
      {"t == f", open},
      {"t + f && x", open},
      {"g(t && f)", open},
      {"g(t && f) || t", yes},
      {"f & x && f", no},
      {"t ? f : f", open},
      {"t || x ? f : f", open},
      {"x, t", open},
      {"(x, t)", open},
      {"t = f", open},
      {"a[t && f] || f", open},
      {"!(t) < x", open},
  };
  for (const Case& one : cases) EXPECT_EQ(of(one.expression), one.truth) << one.expression;
}

}  // namespace
}  // namespace tessera::spec

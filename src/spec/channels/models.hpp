#pragma once

#include <string>
#include <vector>

#include "spec/document/document.hpp"
#include "spec/model/model.hpp"

namespace tessera::spec {

/// The section `models` of a file: communication models of the author.
class CommunicationModels {
 public:
  /// Reads the section into model.models. section may be null.
  ///
  /// Errors: E102, E103 and E104 form; E105, E106 and E107 names; E203 and E204 numbers; those of read_side;
  /// E124 more than a channel has room for. Warnings: W320 a shared place that no transition uses.
  void read(const Entry* section, Model& model, Diagnostics& out);

  /// The model with that name; none after an error, here or in the model. Errors: E101.
  [[nodiscard]] CommunicationModelId find(const Node& name, Diagnostics& out);
  /// Warnings: W321.
  void complain_about_unused(const Model& model, Diagnostics& out) const;

 private:
  struct Known {
    std::string name;
    CommunicationModelId id{};  ///< none: the model has mistakes
    bool used = false;
  };
  std::vector<Known> known_;
  bool one_is_unknown_ = false;
};

/// One side of a model whose slots and shared places are known. what: "send" or "receive".
///
/// Errors: E101 places that an arc names; E103 no `in`, `out`, operation or arc; E107 names; E120 the
///         operation of the other side; E121 a slot that the memory does not have; E122 a transition that
///         does not take one place of the side and give one, an arc into `in` or out of `out`; E123 places
///         that are not on a way from `in` to `out`.
[[nodiscard]] ModelSide read_side(const Entry& entry, const CommunicationModel& around, Diagnostics& out);

}  // namespace tessera::spec

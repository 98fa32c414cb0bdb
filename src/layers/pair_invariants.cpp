#include "layers/pair_invariants.hpp"

#include <algorithm>
#include <numeric>

namespace tessera::layers {
namespace {

using spec::CommunicationModel;
using spec::ModelSide;
using Vector = std::vector<std::int64_t>;

constexpr std::size_t most_rows = 2000;

/// A non-negative combination of places, and what each transition changes it by.
struct Row {
  Vector change, weights;
};

/// The columns of the closed pair: shared places, then those of each side, `in` and `out` as one.
class Columns {
 public:
  explicit Columns(const CommunicationModel& model) : model_(model) {}

  [[nodiscard]] std::size_t of(bool sends, std::uint32_t place) const {
    const std::size_t first = model_.shared.size() + (sends ? 0 : model_.send.places.size() - 1);
    return first + (place <= ModelSide::out ? 0 : place - ModelSide::out);
  }
  [[nodiscard]] std::size_t count() const {
    return model_.shared.size() + model_.send.places.size() + model_.receive.places.size() - 2;
  }

 private:
  const CommunicationModel& model_;
};

std::vector<Row> start(const CommunicationModel& model, const Columns& columns) {
  const std::size_t transitions =
      model.send.transitions.size() + model.receive.transitions.size() + model.medium.size();
  std::vector<Row> rows(columns.count(), {Vector(transitions, 0), Vector(columns.count(), 0)});
  for (std::size_t column = 0; column < rows.size(); ++column) rows[column].weights[column] = 1;
  std::size_t number = 0;
  for (const bool sends : {true, false})
    for (const ModelSide::Transition& transition : (sends ? model.send : model.receive).transitions) {
      --rows[columns.of(sends, transition.from)].change[number];
      ++rows[columns.of(sends, transition.to)].change[number];
      for (const std::uint32_t place : transition.takes) --rows[place].change[number];
      for (const std::uint32_t place : transition.gives) ++rows[place].change[number];
      ++number;
    }
  for (const spec::MediumTransition& transition : model.medium) {
    for (const std::uint32_t place : transition.takes) --rows[place].change[number];
    for (const std::uint32_t place : transition.gives) ++rows[place].change[number];
    ++number;
  }
  return rows;
}

/// The sum of multiples of two rows that no longer changes with the transition.
Row combined(const Row& up, const Row& down, std::size_t transition) {
  const std::int64_t a = -down.change[transition], b = up.change[transition];
  const auto sum = [&](const Vector& x, const Vector& y) {
    Vector result(x.size());
    for (std::size_t at = 0; at < x.size(); ++at) result[at] = a * x[at] + b * y[at];
    return result;
  };
  Row row{sum(up.change, down.change), sum(up.weights, down.weights)};
  std::int64_t divisor = 0;
  for (const Vector* values : {&row.change, &row.weights})
    for (const std::int64_t value : *values) divisor = std::gcd(divisor, value);
  for (Vector* values : {&row.change, &row.weights})
    for (std::int64_t& value : *values) value /= std::max<std::int64_t>(divisor, 1);
  return row;
}

bool covers(const Row& large, const Row& small) {
  for (std::size_t at = 0; at < small.weights.size(); ++at)
    if (small.weights[at] != 0 && large.weights[at] == 0) return false;
  return true;
}

/// Keeps the rows whose places include those of no other row; of equal ones the first.
void keep_minimal(std::vector<Row>& rows) {
  std::vector<Row> kept;
  std::ranges::stable_sort(rows, {}, [](const Row& row) {
    return row.weights.size() - static_cast<std::size_t>(std::ranges::count(row.weights, 0));
  });
  for (Row& row : rows)
    if (std::ranges::none_of(kept, [&](const Row& other) { return covers(row, other); }))
      kept.push_back(std::move(row));
  rows = std::move(kept);
}

std::vector<Vector> semiflows(std::vector<Row> rows) {
  const std::size_t transitions = rows.empty() ? 0 : rows.front().change.size();
  for (std::size_t transition = 0; transition < transitions; ++transition) {
    std::vector<Row> next;
    for (const Row& up : rows) {
      if (up.change[transition] == 0) next.push_back(up);
      if (up.change[transition] <= 0) continue;
      for (const Row& down : rows)
        if (down.change[transition] < 0) next.push_back(combined(up, down, transition));
    }
    keep_minimal(next);
    if (next.size() > most_rows) next.resize(most_rows);
    rows = std::move(next);
  }
  std::vector<Vector> found;
  for (Row& row : rows) found.push_back(std::move(row.weights));
  return found;
}

/// Takes the loops out of a semiflow of the closed pair.
PairInvariant opened(const CommunicationModel& model, const Columns& columns, const Vector& semiflow) {
  PairInvariant invariant;
  for (std::size_t place = 0; place < model.shared.size(); ++place) {
    invariant.shared.push_back(static_cast<std::int32_t>(semiflow[place]));
    invariant.total += semiflow[place] * model.shared[place].tokens;
  }
  for (const bool sends : {true, false}) {
    const ModelSide& side = sends ? model.send : model.receive;
    const std::int64_t idle = semiflow[columns.of(sends, ModelSide::in)];
    std::vector<std::int32_t>& weights = sends ? invariant.send : invariant.receive;
    for (std::uint32_t place = 0; place < side.places.size(); ++place)
      weights.push_back(static_cast<std::int32_t>(semiflow[columns.of(sends, place)] - idle));
  }
  return invariant;
}

}  // namespace

bool PairInvariant::is_unit() const {
  const auto none_negative = [](const std::vector<std::int32_t>& weights) {
    return std::ranges::all_of(weights, [](std::int32_t weight) { return weight >= 0; });
  };
  return total == 1 && none_negative(shared) && none_negative(send) && none_negative(receive);
}

std::vector<PairInvariant> pair_invariants(const CommunicationModel& model) {
  const Columns columns(model);
  std::vector<PairInvariant> found;
  for (const Vector& semiflow : semiflows(start(model, columns))) {
    PairInvariant invariant = opened(model, columns, semiflow);
    const bool speaks =
        std::ranges::any_of(invariant.shared, [](std::int32_t weight) { return weight != 0; });
    if (speaks) found.push_back(std::move(invariant));
  }
  std::stable_partition(found.begin(), found.end(),
                        [](const PairInvariant& invariant) { return invariant.is_unit(); });
  return found;
}

}  // namespace tessera::layers

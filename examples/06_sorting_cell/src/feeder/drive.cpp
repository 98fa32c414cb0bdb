#include "feeder/drive.hpp"

namespace sorting_cell::feeder::drive {

/// Behaviour drive of feeder.drive.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.speed; }

}  // namespace sorting_cell::feeder::drive

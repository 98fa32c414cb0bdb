#include "belt/drive.hpp"

namespace sorting_cell::belt::drive {

/// Behaviour drive of belt.drive.
void drive(Context& context, const Inputs& in, Memory& memory, Outputs& out) { out.command = in.speed; }

}  // namespace sorting_cell::belt::drive

#pragma once

#include "command_log.hpp"

/// Does the harm that the log asks for, if it asks for it at this place; once.
void suffer(command_log::Place place);

#pragma once

#include <cxxabi.h>

#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/run_control.hpp"

namespace tessera {

/// Runs `code` as the outermost function of a thread. An exception stops the run, as a fault, instead of the
/// process. false: `code` has thrown. The end of a thread (pthread_exit) passes through.
template <class Code>
bool survives_in_thread(RunControl& control, std::string_view who, Code&& code) {
  std::string_view what = "an exception that is no std::exception";
  std::string text;
  try {
    std::forward<Code>(code)();
    return true;
  } catch (const abi::__forced_unwind&) {
    throw;
  } catch (const std::exception& exception) {
    try {
      text = std::string(who) + ": " + exception.what();
      what = text;
    } catch (...) {
      what = who;  // no memory for more
    }
  } catch (...) {
  }
  control.request_stop(what, /*fault=*/true);
  return false;
}

}  // namespace tessera

#include <algorithm>
#include <exception>
#include <string_view>

#include "network/dds/carrier.hpp"
#include "network/dds/status/status_reader.hpp"

namespace {

void copy_text(std::string_view text, char* target, std::size_t size) {
  if (size == 0) return;
  const std::size_t length = std::min(text.size(), size - 1);
  std::copy_n(text.data(), length, target);
  target[length] = '\0';
}

}  // namespace

/// Makes a carrier over Cyclone DDS; throws nothing. See tessera::network::OpenCarrier.
extern "C" __attribute__((visibility("default"))) tessera::network::Carrier* tessera_open_carrier_4(
    const tessera::network::CarrierSetup& setup, char* error, std::size_t size) {
  try {
    return new tessera::dds::DdsCarrier(setup);
  } catch (const std::exception& problem) {
    copy_text(problem.what(), error, size);
    return nullptr;
  }
}

/// Makes a reader of the status of processes; throws nothing. See tessera::network::OpenStatusReader.
extern "C" __attribute__((visibility("default"))) tessera::network::StatusReader*
tessera_open_status_reader_1(const tessera::network::StatusReaderSetup& setup, char* error,
                             std::size_t size) {
  try {
    return new tessera::dds::DdsStatusReader(setup);
  } catch (const std::exception& problem) {
    copy_text(problem.what(), error, size);
    return nullptr;
  }
}

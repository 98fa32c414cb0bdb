#pragma once

#include <memory>
#include <string>
#include <vector>

/// Compression of answers by gzip.
namespace tessera::server {

enum class Effort { quick = 1, best = 9 };

/// The pieces as one gzip stream. Empty: compression failed.
[[nodiscard]] std::string gzip(const std::vector<std::shared_ptr<const std::string>>& pieces, Effort effort);

}  // namespace tessera::server

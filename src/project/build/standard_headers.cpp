#include "project/build/standard_headers.hpp"

#include <algorithm>
#include <array>

namespace tessera::project {

namespace {

struct Header {
  std::string_view header;
  std::string_view names;  ///< with a blank around each
};

constexpr std::array headers = std::to_array<Header>(
    {{"<cmath>",
      " abs acos asin atan atan2 ceil copysign cos exp fabs floor fmod fmax fmin hypot isfinite isinf isnan "
      "log "
      "log10 log2 lround pow remainder round sin sqrt tan tanh trunc lerp "},
     {"<algorithm>",
      " all_of any_of clamp copy count count_if fill find find_if for_each max max_element min min_element "
      "minmax none_of reverse rotate sort transform unique "},
     {"<numeric>", " accumulate iota inner_product partial_sum reduce midpoint gcd lcm "},
     {"<numbers>", " numbers "},
     {"<vector>", " vector "},
     {"<array>", " array to_array "},
     {"<string>", " string to_string stoi stod "},
     {"<string_view>", " string_view "},
     {"<map>", " map multimap "},
     {"<set>", " set multiset "},
     {"<unordered_map>", " unordered_map "},
     {"<deque>", " deque "},
     {"<queue>", " queue priority_queue "},
     {"<optional>", " optional nullopt "},
     {"<variant>", " variant "},
     {"<memory>", " unique_ptr shared_ptr make_unique make_shared "},
     {"<functional>", " function "},
     {"<tuple>", " tuple tie "},
     {"<utility>", " pair move swap exchange "},
     {"<random>", " mt19937 uniform_real_distribution normal_distribution uniform_int_distribution "},
     {"<limits>", " numeric_limits "},
     {"<stdexcept>", " runtime_error logic_error invalid_argument out_of_range "},
     {"<iostream>", " cout cerr cin endl "},
     {"<fstream>", " ifstream ofstream fstream "},
     {"<sstream>", " ostringstream istringstream stringstream "},
     {"<chrono>", " chrono "},
     {"<thread>", " thread this_thread "},
     {"<mutex>", " mutex lock_guard unique_lock "},
     {"<cstdint>", " uint8_t uint16_t uint32_t uint64_t int8_t int16_t int32_t int64_t "},
     {"<cstdio>", " printf fprintf "},
     {"<cstdlib>", " rand srand exit "}});

}  // namespace

std::string standard_header(std::string_view name) {
  const std::string word = " " + std::string(name) + " ";
  const auto found = std::ranges::find_if(
      headers, [&](const Header& one) { return one.names.find(word) != std::string_view::npos; });
  return found == headers.end() ? "" : std::string(found->header);
}

}  // namespace tessera::project

#include "server/http/assets.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "project/files/files.hpp"
#include "server/http/packing.hpp"

namespace tessera::server {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view not_built = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Tessera Studio</title>
<body style="font-family: sans-serif; max-width: 40em; margin: 4em auto; line-height: 1.5">
<h1>The studio's page was not built</h1>
<p>The server runs, but this build of Tessera has no page for it. Build it with npm in the source tree:</p>
<pre>cd studio/web &amp;&amp; npm ci &amp;&amp; npm run build</pre>
<p>and start <code>tessera studio</code> again.</p>
</body></html>
)";

std::string type_of(const fs::path& file) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 12> types{
      {{".html", "text/html; charset=utf-8"},
       {".js", "text/javascript; charset=utf-8"},
       {".mjs", "text/javascript; charset=utf-8"},
       {".css", "text/css; charset=utf-8"},
       {".json", "application/json"},
       {".map", "application/json"},
       {".svg", "image/svg+xml"},
       {".png", "image/png"},
       {".ico", "image/x-icon"},
       {".woff2", "font/woff2"},
       {".wasm", "application/wasm"},
       {".txt", "text/plain; charset=utf-8"}}};
  for (const auto& [ending, type] : types)
    if (file.extension() == ending) return std::string(type);
  return "application/octet-stream";
}

Assets::Asset asset(std::string bytes, std::string type) {
  constexpr std::size_t small = 1024;
  Assets::Asset made{std::make_shared<const std::string>(std::move(bytes)), nullptr, std::move(type)};
  if (made.bytes->size() < small) return made;
  std::string packed = gzip({made.bytes}, Effort::best);
  if (!packed.empty() && packed.size() < made.bytes->size() / 10 * 9)
    made.packed = std::make_shared<const std::string>(std::move(packed));
  return made;
}

}  // namespace

Assets::Assets(const fs::path& folder) {
  std::error_code ignored;
  for (fs::recursive_directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (entry->is_symlink() || !entry->is_regular_file()) continue;
    files_["/" + fs::relative(entry->path(), folder).generic_string()] =
        asset(project::content_of(entry->path()), type_of(entry->path()));
  }
  for (const auto& [address, file] :
       {std::pair{"/", "/index.html"}, std::pair{"/operate", "/operate.html"}}) {
    const auto page = files_.find(file);
    files_[address] = page == files_.end() ? asset(std::string(not_built), "text/html; charset=utf-8")
                                           : Asset(page->second);
  }
}

const Assets::Asset* Assets::find(const std::string& path) const {
  const auto found = files_.find(path);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace tessera::server

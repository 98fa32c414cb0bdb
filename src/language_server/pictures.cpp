#include "language_server/pictures.hpp"

#include <stdlib.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "drawing/drawing.hpp"
#include "language_server/workspace.hpp"
#include "project/files/files.hpp"

namespace tessera::language_server {

namespace fs = std::filesystem;

namespace {

/// A larger page cannot be read in a tooltip.
constexpr std::size_t most_elements = 80;
/// VS Code cuts Markdown after 100,000 characters.
constexpr std::size_t longest_uri = 80'000;
constexpr std::size_t most_files = 16;

/// The page of an agent, subsystem or behaviour. Members of a fleet are alike, and so are users of a template: the first
/// one stands for all.
net::PageId page_of(const net::HierarchicalNet& net, const language::PageName& name) {
  if (const net::PageId page = net.find(name.path); page.valid()) return page;
  const std::string last = name.path.substr(name.path.rfind('.') + 1);
  const auto found = std::ranges::find_if(net.pages, [&](const net::Page& page) {
    return page.span.line == name.line && (page.name == last || page.name == last + "[0]");
  });
  return found == net.pages.end() ? net::PageId{}
                                  : net::PageId{static_cast<std::uint32_t>(found - net.pages.begin())};
}

std::string drawn(const net::HierarchicalNet& net, net::PageId page) {
  try {
    return drawing::to_svg(net, page);
  } catch (const drawing::LayoutError&) {
    return {};
  }
}

using Clock = std::chrono::steady_clock;

bool is_ready(const std::shared_future<std::string>& picture, Clock::time_point latest) {
  return picture.wait_until(latest) == std::future_status::ready;
}

}  // namespace

Pictures::~Pictures() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void Pictures::keep(const std::string& uri, const std::string& text,
                    std::shared_ptr<const net::HierarchicalNet> pages) {
  const std::lock_guard lock(mutex_);
  if (pages == nullptr)
    kept_.erase(uri);
  else
    kept_[uri] = {text, std::move(pages), {}};
}

void Pictures::forget(const std::string& uri) {
  const std::lock_guard lock(mutex_);
  kept_.erase(uri);
}

std::string Pictures::markdown(const std::string& uri, const std::string& text,
                               const language::PageName& name, PictureForm form,
                               std::chrono::milliseconds patience) {
  if (form == PictureForm::none || name.path.empty()) return {};
  const Clock::time_point latest = Clock::now() + patience;
  const std::lock_guard lock(mutex_);
  const auto kept = kept_.find(uri);
  if (kept == kept_.end() || kept->second.text != text) return {};
  const std::shared_ptr<const net::HierarchicalNet> net = kept->second.pages;
  const net::PageId id = page_of(*net, name);
  if (!id.valid()) return {};
  const net::Page& page = net->pages[id.value];
  if (page.nodes.size() + page.transitions.size() > most_elements) return {};
  std::shared_future<std::string>& picture = kept->second.drawn[id.value];
  if (!picture.valid()) {
    if (last_.valid() && !is_ready(last_, latest)) return {};
    last_ = picture = std::async(std::launch::async, [net, id] { return drawn(*net, id); }).share();
  }
  if (!is_ready(picture, latest) || picture.get().empty()) return {};
  std::string source;
  if (form == PictureForm::embedded)
    source = "data:image/svg+xml," + escaped(picture.get());
  else
    source = file_of(picture.get());
  if (source.empty() || source.size() > longest_uri) return {};
  return "![page " + net->path(id) + "](" + source + ")";
}

std::string Pictures::file_of(const std::string& svg) {
  if (folder_.empty()) {
    std::error_code problem;
    std::string pattern = (fs::temp_directory_path(problem) / "tessera-lsp-XXXXXX").string();
    if (problem || ::mkdtemp(pattern.data()) == nullptr) return {};
    folder_ = pattern;
  }
  // A new name for each picture: editors keep what they have read.
  files_.push_back(folder_ / (std::to_string(++made_) + ".svg"));
  project::write_file(files_.back(), svg);
  std::error_code ignored;
  if (files_.size() > most_files) {
    fs::remove(files_.front(), ignored);
    files_.pop_front();
  }
  return uri_of(files_.back());
}

}  // namespace tessera::language_server

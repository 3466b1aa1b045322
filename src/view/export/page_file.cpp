// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/page_file.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "view/server/page.hpp"
#include "view/export/saved_mesh.hpp"
#include "view/export/sha256.hpp"

namespace isotet::view {

namespace {

Error not_a_module(std::string_view name, std::string_view rule) {
    return {ErrorCode::internal, fmt::format("{} of the page {}", name, rule)};
}

/// Takes the line off the front of a text, without its end.
std::string_view next_line(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

/// What stands between two marks; empty where they are not there.
std::string_view between_marks(std::string_view line, std::string_view before, std::string_view after) {
    const std::size_t begin = line.find(before);
    if (begin == std::string_view::npos) return {};
    line.remove_prefix(begin + before.size());
    const std::size_t end = line.find(after);
    return end == std::string_view::npos ? std::string_view{} : line.substr(0, end);
}

/// "camera.js" of "import {Camera} from './draw/camera.js';"; empty where a line imports nothing.
std::string_view imported_file(std::string_view line) {
    if (!line.starts_with("import ")) return {};
    const std::string_view path = between_marks(line, "'", "';");
    return path.starts_with('.') ? path.substr(path.rfind('/') + 1) : std::string_view{};
}

/// "rounded" of "export function rounded(value) {"; empty where a line declares nothing.
std::string_view declared_name(std::string_view line) {
    for (const std::string_view word : {"export ", "async ", "const ", "let ", "function ", "class "})
        if (line.starts_with(word)) line.remove_prefix(word.size());
    return line.substr(0, line.find_first_of(" (=;"));
}

class Bundler {
public:
    Bundler(std::span<const PageModule> modules, const std::pair<std::string_view, std::string_view>& replacement)
        : modules_(modules), replacement_(replacement) {}

    Result<void> add(std::string_view name) {
        if (name == replacement_.first) name = replacement_.second;
        if (!added_.insert(name).second) return {}; // also where modules import each other
        const auto found = std::ranges::find(modules_, name, &PageModule::name);
        if (found == modules_.end()) return not_a_module(name, "is not there");
        std::string own, whole;
        std::vector<std::string_view> exported;
        for (std::string_view text = found->text; !text.empty();) {
            const std::string_view line = next_line(text);
            if (line.starts_with("import ")) {
                if (Result<void> imported = import(name, line); !imported) return imported;
            } else if (line.starts_with("export ")) {
                exported.push_back(declared_name(line));
                own += line.substr(std::string_view("export ").size());
                own += '\n';
            } else if (!line.starts_with("// Copyright")) {
                own += line;
                own += '\n';
            }
        }
        out_ += own;
        if (const std::string_view space = space_of(name); !space.empty())
            out_ += fmt::format("const {} = {{{}}};\n", space, fmt::join(exported, ", "));
        return {};
    }

    std::string take() { return std::move(out_); }

private:
    Result<void> import(std::string_view name, std::string_view line) {
        const std::string_view imported = imported_file(line);
        if (imported.empty()) return not_a_module(name, fmt::format("imports by the line \"{}\"", line));
        return add(imported);
    }

    /// NAME of `import * as NAME` of a module, anywhere; empty where there is none.
    std::string_view space_of(std::string_view name) const {
        for (const PageModule& module : modules_)
            for (std::string_view text = module.text; !text.empty();)
                if (const std::string_view line = next_line(text); imported_file(line) == name)
                    if (const auto space = between_marks(line, "import * as ", " from"); !space.empty()) return space;
        return {};
    }

    std::span<const PageModule> modules_;
    std::pair<std::string_view, std::string_view> replacement_;
    std::set<std::string_view> added_;
    std::string out_;
};

/// Puts a text in the place of another one that stands there once.
bool replace_once(std::string& text, std::string_view old, std::string_view with) {
    const std::size_t at = text.find(old);
    if (at == std::string::npos) return false;
    text.replace(at, old.size(), with);
    return true;
}

std::string hash_source(std::string_view text) { return fmt::format("'sha256-{}'", base64_of(sha256(text))); }

std::string_view text_of_file(const std::vector<ServedFile>& files, std::string_view name) {
    const auto found = std::ranges::find(files, name, &ServedFile::name);
    return found == files.end() ? std::string_view{} : found->content;
}

std::string_view link_of(PageSource source) {
    if (source == PageSource::files) return "files_link.js";
    return source == PageSource::grid ? "wasm_link.js" : "saved_link.js";
}

} // namespace

Result<std::string> bundle(std::span<const PageModule> modules, std::string_view first,
                           const std::pair<std::string_view, std::string_view>& replacement) {
    Bundler bundler(modules, replacement);
    if (Result<void> added = bundler.add(first); !added) return added.error();
    return bundler.take();
}

std::string html_text(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&') out += "&amp;";
        else if (c == '<') out += "&lt;";
        else if (c == '>') out += "&gt;";
        else if (c == '"') out += "&quot;";
        else if (c == '\'') out += "&#39;";
        else out += c;
    }
    return out;
}

std::string json_in_html(const Json& json) {
    std::string out;
    for (const char c : text_of(json)) {
        if (c == '<') out += "\\u003c"; // only texts of JSON have it
        else out += c;
    }
    return out;
}

Result<std::string> page_document(std::string_view title, const Json& saved, const std::vector<PagePart>& parts,
                                  PageSource source) {
    const std::vector<ServedFile> files = page_files();
    std::vector<PageModule> modules;
    for (const ServedFile& file : files)
        if (file.name.ends_with(".js")) modules.push_back({file.name, file.content});
    const bool has_engine = source != PageSource::surfaces;
    const Result<std::string> script = bundle(modules, "main.js", {"link.js", link_of(source)});
    if (!script) return script.error();
    const std::string_view style = text_of_file(files, "style.css");
    const std::string policy = fmt::format(
        "default-src 'none'; script-src {}{}; style-src {}; img-src data: blob:; base-uri 'none'; "
        "form-action 'none'",
        hash_source(*script), has_engine ? " 'wasm-unsafe-eval'; worker-src blob: data:" : "", hash_source(style));
    std::string data = fmt::format("<script type=\"application/json\" id=\"saved\">{}</script>\n", json_in_html(saved));
    for (const PagePart& part : parts)
        data += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", html_text(part.name), part.base64);
    if (has_engine) {
        const Result<std::string> worker = bundle(modules, "engine_worker.js", {});
        if (!worker) return worker.error();
        const Result<std::string> packed = deflated(*worker);
        if (!packed) return packed.error();
        data += fmt::format("<script type=\"text/plain\" id=\"worker\">{}</script>\n", base64_of(*packed));
    }

    std::string html(text_of_file(files, "index.html"));
    const bool fits =
        replace_once(html, "<meta charset=\"utf-8\">",
                     fmt::format("<meta charset=\"utf-8\">\n"
                                 "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">",
                                 policy)) &&
        replace_once(html, "<title>isotet view</title>", fmt::format("<title>{}</title>", html_text(title))) &&
        replace_once(html, "<link rel=\"stylesheet\" href=\"style.css\">", fmt::format("<style>{}</style>", style)) &&
        replace_once(html, "<script type=\"module\" src=\"main.js\"></script>\n", "") &&
        replace_once(html, "</body>", data + fmt::format("<script type=\"module\">{}</script>\n</body>", *script));
    if (!fits) return Error{ErrorCode::internal, "index.html of the page has not the lines that a file of it replaces"};
    return html;
}

} // namespace isotet::view

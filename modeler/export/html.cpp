// A page that shows the model, in one file that asks for nothing else: the mesh packed, with scripts that draw it.
#include <span>

#include "modeler/export/formats.h"
#include "modeler/export/out_file.h"
#include "modeler/export/page_data.h"
#include "modeler/export/page_text.h"

namespace sgm::exporter {
namespace {

/// Text between tags.
std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : oneLine(validUtf8(text))) switch (c) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            default:
                safe += c;
        }
    return safe;
}

/// Writes base64 (RFC 4648).
void writeBase64(OutFile& out, std::span<const uint8_t> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < bytes.size() && !out.failed(); i += 3) {
        const size_t left = std::min<size_t>(3, bytes.size() - i);
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < left ? bytes[i + k] : 0u);
        char text[4];
        for (size_t k = 0; k < 4; ++k) text[k] = k <= left ? digits[word >> (18 - 6 * k) & 63] : '=';
        out.bytes(text, 4);
    }
}

}  // namespace

static Status writeHtml(const ExportInput& input, const Path& temporary, const Path& target) {
    const auto packed = packPage(input);
    if (!packed.ok()) return packed.error();
    OutFile out(temporary, target, input.progress);
    std::string_view page = pageText();
    for (size_t at; (at = page.find('@')) != std::string_view::npos;) {
        out.text(page.substr(0, at));
        page.remove_prefix(at);
        if (page.starts_with("@TITLE@")) {
            out.text(escaped(input.name));
            page.remove_prefix(7);
        } else if (page.starts_with("@DATA@")) {
            writeBase64(out, *packed);
            page.remove_prefix(6);
        } else {
            out.text(page.substr(0, 1));
            page.remove_prefix(1);
        }
    }
    out.text(page);
    return out.finish();
}

constinit const Exporter htmlFormat{
    .extension = ".html",
    .doc = "A page that shows the model in a browser, without any network: orbit, parts, section, materials, measure",
    .options = {},
    .takesPositionsOnly = nullptr,
    .write = writeHtml,
    .stream = nullptr,
    .holdsObjects = true,
};

}  // namespace sgm::exporter

// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/report.h"

#include "hone/core/image/png.h"

namespace hone::cli {
namespace {

std::string base64(std::span<const std::byte> bytes) {
    static constexpr char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
        uint group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8u | (k < left ? std::to_integer<uint>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= left ? kDigits[(group >> (18u - 6u * k)) & 63u] : '=';
    }
    return text;
}

constexpr const char* kStyle =
    "body{font:16px/1.5 system-ui,sans-serif;max-width:76rem;margin:2rem auto;padding:0 "
    "1rem;color:#1c1c1e;background:#fafafa}"
    "h1{font-size:1.6rem}h2{font-size:1.15rem;margin-top:2rem}"
    ".pictures{display:grid;grid-template-columns:repeat(auto-fit,minmax(28rem,1fr));gap:1.2rem}"
    "figure{margin:0}img{width:100%;display:block;border-radius:4px}figcaption{font-size:.9rem;"
    "color:#444;padding:.3rem 0}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums}td,th{padding:.15rem .9rem "
    ".15rem 0;text-align:left;"
    "border-bottom:1px solid #ddd}";

} // namespace

std::string escapeHtml(std::string_view text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
        case '<':
            safe += "&lt;";
            break;
        case '>':
            safe += "&gt;";
            break;
        case '&':
            safe += "&amp;";
            break;
        case '"':
            safe += "&quot;";
            break;
        case '\'':
            safe += "&#39;";
            break;
        default:
            safe += c;
        }
    }
    return safe;
}

std::string toHtml(const Report& report) {
    std::string html = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                       escapeHtml(report.title) + "</title><style>" + kStyle +
                       "</style></head><body>\n<h1>" + escapeHtml(report.title) + "</h1>\n<p>" +
                       escapeHtml(report.summary) + "</p>\n<div class=\"pictures\">\n";
    for (const ReportPicture& picture : report.pictures)
        html += "<figure><img alt=\"" + escapeHtml(picture.caption) +
                "\" src=\"data:image/png;base64," + base64(encodePng(picture.image)) +
                "\"><figcaption><b>" + escapeHtml(picture.title) + "</b> – " +
                escapeHtml(picture.caption) + "</figcaption></figure>\n";
    html += "</div>\n<div class=\"pictures\">\n";
    for (const ReportDrawing& drawing : report.drawings)
        html += "<figure>" + drawing.svg + "<figcaption>" + escapeHtml(drawing.caption) +
                "</figcaption></figure>\n";
    html += "</div>\n";
    for (const ReportTable& table : report.tables) {
        html += "<h2>" + escapeHtml(table.title) + "</h2>\n<table><tr>";
        for (const std::string& cell : table.head)
            html += "<th>" + escapeHtml(cell) + "</th>";
        html += "</tr>\n";
        for (const std::vector<std::string>& row : table.rows) {
            html += "<tr>";
            for (const std::string& cell : row)
                html += "<td>" + escapeHtml(cell) + "</td>";
            html += "</tr>\n";
        }
        html += "</table>\n";
    }
    return html + "</body></html>\n";
}

} // namespace hone::cli

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/graph/executor.h"
#include "hone/core/image/decode.h"

#include <string>
#include <vector>

namespace hone::cli {

struct ReportPicture {
    std::string title;
    std::string caption; ///< also the picture's text alternative
    Image8 image;
};

struct ReportDrawing {
    std::string caption;
    std::string svg; ///< of toSvg(); put in as it is
};

struct ReportTable {
    std::string title;
    std::vector<std::string> head;
    std::vector<std::vector<std::string>> rows;
};

struct Report {
    std::string title;
    std::string summary;
    std::vector<ReportPicture> pictures;
    std::vector<ReportTable> tables;
    std::vector<ReportDrawing> drawings{};
};

/// One HTML file that needs nothing else: pictures inside, no script, no network. All text is
/// escaped.
[[nodiscard]] std::string toHtml(const Report& report);

/// Text made safe between tags and in quoted attributes.
[[nodiscard]] std::string escapeHtml(std::string_view text);

} // namespace hone::cli

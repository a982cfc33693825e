#include "tools/batch/batch_report.h"

#include <algorithm>
#include <array>

#include "tools/batch/batch_page_parts.h"
#include "tools/batch/batch_scatter.h"
#include "tools/batch/html_text.h"
#include "tools/commands.h"

namespace gim {
namespace {

using State = BatchRow::State;

std::string base64(const Bytes& bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k) group = group << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
        for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

uint64_t count(const std::vector<BatchRow>& rows, State state) {
    return static_cast<uint64_t>(
        std::count_if(rows.begin(), rows.end(), [&](const BatchRow& row) { return row.state == state; }));
}

std::string fact(const char* name, const std::string& value) {
    return std::string("<dt>") + name + "</dt><dd>" + value + "</dd>\n";
}

std::string facts(const BatchPage& page) {
    BatchFigures sum;
    for (const BatchRow& row : page.rows) {
        if (row.state != State::kDone) continue;
        sum.bytes += row.figures.bytes;
        sum.input_bytes += row.figures.input_bytes;
        sum.triangles += row.figures.triangles;
        sum.seconds += row.figures.seconds;
    }
    std::string text = "<dl>\n" + fact("files", with_thousands(page.rows.size()));
    for (const State state : {State::kDone, State::kFailed, State::kRunning, State::kWaiting}) {
        if (const uint64_t number = count(page.rows, state); number > 0)
            text += fact(name_of(state), with_thousands(number));
    }
    text += fact("bytes", with_thousands(sum.bytes) + ", from " + with_thousands(sum.input_bytes));
    text += fact("triangles", with_thousands(sum.triangles));
    text += fact("encoding", decimal(sum.seconds, 1) + " s, added up");
    for (const std::string& options : page.options)
        text += fact("options", options.empty() ? "none" : "<code>" + html_text(options) + "</code>");
    return text + "</dl>\n";
}

std::string failures(const std::vector<BatchRow>& rows) {
    if (count(rows, State::kFailed) == 0) return {};
    std::string text = "<h2 id=\"failed\">Failed</h2>\n<ul>\n";
    for (const BatchRow& row : rows) {
        if (row.state == State::kFailed)
            text += "<li><code>" + html_text(row.path) + "</code>: " + html_text(row.reason) + "</li>\n";
    }
    return text + "</ul>\n";
}

std::string cell(const char* label, const std::string& key, const std::string& shown) {
    return std::string("<td data-label=\"") + label + "\" data-key=\"" + key + "\">" + shown + "</td>";
}

std::string picture(const BatchRow& row) {
    if (row.thumbnail.empty() || row.state != State::kDone) return "<td class=\"picture\"></td>";
    return "<td class=\"picture\"><img loading=\"lazy\" alt=\"" + html_text("decoded surface of " + row.name) +
           "\" src=\"data:image/png;base64," + base64(row.thumbnail) + "\"></td>";
}

std::string table_row(const BatchRow& row) {
    const BatchFigures& figures = row.figures;
    std::string text = "<tr>" + picture(row) + "<td class=\"name text\">" + html_text(row.name) + "</td>";
    const std::string state = name_of(row.state);
    text += "<td class=\"text " + state + "\">" + state + "</td>";
    if (row.state != State::kDone) {
        for (int i = 0; i < 7; ++i) text += "<td data-key=\"-1\"></td>";
        return text + "</tr>\n";
    }
    text += cell("triangles", std::to_string(figures.triangles), with_thousands(figures.triangles));
    text += cell("bytes", std::to_string(figures.bytes), with_thousands(figures.bytes));
    text += figures.psnr ? cell("PSNR", decimal(*figures.psnr, 4), decimal(*figures.psnr, 2) + " dB")
                         : cell("PSNR", "1e9", "exact");
    const double bits =
        figures.triangles > 0 ? 8.0 * static_cast<double>(figures.bytes) / static_cast<double>(figures.triangles) : 0;
    text += cell("bits a triangle", decimal(bits, 4), decimal(bits, 2));
    text += cell("folded", std::to_string(figures.folded), with_thousands(figures.folded));
    text += cell("time", decimal(figures.seconds, 4), decimal(figures.seconds, 1) + " s");
    text += cell("layout", html_text(figures.layout), html_text(figures.layout));
    return text + "</tr>\n";
}

std::string table(const std::vector<BatchRow>& rows) {
    struct Head {
        const char *name, *kind;
    };
    constexpr std::array<Head, 9> kHeads = {{{"file", "text"},
                                             {"state", "text"},
                                             {"triangles", "number"},
                                             {"bytes", "number"},
                                             {"PSNR", "number"},
                                             {"bits a triangle", "number"},
                                             {"folded", "number"},
                                             {"time", "number"},
                                             {"layout", "text"}}};
    std::string text = "<h2>Files</h2>\n<div class=\"wide\"><table id=\"files\">\n<thead><tr><th></th>";
    for (const Head& head : kHeads) {
        text += std::string("<th scope=\"col\" data-kind=\"") + head.kind + "\"><button type=\"button\">" + head.name +
                "</button></th>";
    }
    text += "</tr></thead>\n<tbody>\n";
    for (const BatchRow& row : rows) text += table_row(row);
    return text + "</tbody>\n</table></div>\n";
}

}  // namespace

std::string batch_html(const BatchPage& page) {
    std::string text =
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>gim batch: " +
        with_thousands(page.rows.size()) + " files</title>\n<style>" + kBatchStyle +
        "</style>\n</head>\n<body>\n<h1>gim batch</h1>\n";
    text += facts(page);
    for (const std::string& note : page.notes) text += "<p>" + html_text(note) + "</p>\n";
    text += failures(page.rows);
    if (const std::string scatter = batch_scatter(page.rows); !scatter.empty())
        text += "<h2>Bytes and PSNR</h2>\n" + scatter;
    text += table(page.rows);
    return text + "<script>" + kBatchScript + "</script>\n</body>\n</html>\n";
}

}  // namespace gim

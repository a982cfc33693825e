#include "tools/batch/batch_scatter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/batch/html_text.h"
#include "tools/commands.h"

namespace gim {
namespace {

constexpr double kWidth = 400, kHeight = 300, kLeft = 40, kRight = 32, kTop = 30, kBottom = 46;  // pixels
constexpr std::array<const char*, 3> kLayouts = {"gim", "mcgim", "tiles"};

struct Range {
    double low = 0, high = 0;
    double part(double value) const { return (value - low) / (high - low); }
};

bool has_dot(const BatchRow& row) {
    return row.state == BatchRow::State::kDone && row.figures.psnr && row.figures.bytes > 0;
}

double decades(uint64_t bytes) { return std::log10(static_cast<double>(bytes)); }

class Scatter {
  public:
    explicit Scatter(const std::vector<const BatchRow*>& rows) : rows_(rows) {
        const auto [few, many] = std::minmax_element(
            rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->figures.bytes < b->figures.bytes; });
        const auto [worst, best] = std::minmax_element(
            rows.begin(), rows.end(), [](const auto* a, const auto* b) { return *a->figures.psnr < *b->figures.psnr; });
        // At least one step each way, so that one dot lies in the middle.
        bytes_ = {std::floor(decades((*few)->figures.bytes)), std::ceil(decades((*many)->figures.bytes) + 0.001)};
        psnr_ = {5 * std::floor(*(*worst)->figures.psnr / 5 - 0.2), 5 * std::ceil(*(*best)->figures.psnr / 5 + 0.2)};
    }

    std::string svg() const {
        std::string text = "<svg viewBox=\"0 0 " + decimal(kWidth, 0) + " " + decimal(kHeight, 0) +
                           "\" role=\"img\" aria-label=\"Bytes of each file against its PSNR\">\n";
        for (int power = static_cast<int>(bytes_.low); power <= static_cast<int>(bytes_.high); ++power)
            text += column(power);
        const double step = psnr_.high - psnr_.low > 40 ? 10 : 5;
        for (double level = psnr_.low; level <= psnr_.high; level += step) text += line(level);
        text += label(kLeft, 18, "start", "PSNR in dB");
        text += label(kWidth - kRight, kHeight - 6, "end", "bytes of the file");
        text += legend();
        for (const BatchRow* row : rows_) text += dot(*row);
        return text + "</svg>\n";
    }

  private:
    double x(double power) const { return kLeft + bytes_.part(power) * (kWidth - kLeft - kRight); }
    double y(double level) const { return kHeight - kBottom - psnr_.part(level) * (kHeight - kTop - kBottom); }

    static std::string label(double x, double y, const char* anchor, const std::string& text) {
        return "<text x=\"" + decimal(x, 1) + "\" y=\"" + decimal(y, 1) + "\" text-anchor=\"" + anchor + "\">" + text +
               "</text>\n";
    }
    static std::string stroke(double x1, double y1, double x2, double y2) {
        return "<line class=\"grid\" x1=\"" + decimal(x1, 1) + "\" y1=\"" + decimal(y1, 1) + "\" x2=\"" +
               decimal(x2, 1) + "\" y2=\"" + decimal(y2, 1) + "\"/>\n";
    }
    std::string column(int power) const {
        const auto bytes = static_cast<uint64_t>(std::llround(std::pow(10, power)));
        return stroke(x(power), kTop, x(power), kHeight - kBottom) +
               label(x(power), kHeight - kBottom + 18, "middle", with_thousands(bytes));
    }
    std::string line(double level) const {
        return stroke(kLeft, y(level), kWidth - kRight, y(level)) +
               label(kLeft - 8, y(level) + 4, "end", decimal(level, 0));
    }
    std::string legend() const {
        std::string text;
        double place = kWidth - kRight - 70;
        for (const char* layout : kLayouts) {
            const auto has_layout = [&](const BatchRow* row) { return row->figures.layout == layout; };
            if (std::none_of(rows_.begin(), rows_.end(), has_layout)) continue;
            text +=
                std::string("<circle class=\"") + layout + "\" cx=\"" + decimal(place, 1) + "\" cy=\"14\" r=\"5\"/>\n";
            text += label(place + 10, 18, "start", layout);
            place -= 80;
        }
        return text;
    }
    std::string dot(const BatchRow& row) const {
        const BatchFigures& figures = row.figures;
        return "<circle class=\"" + html_text(figures.layout) + "\" cx=\"" + decimal(x(decades(figures.bytes)), 1) +
               "\" cy=\"" + decimal(y(*figures.psnr), 1) + "\" r=\"4\" fill-opacity=\"0.75\"><title>" +
               html_text(row.name) + ": " + with_thousands(figures.bytes) + " bytes, " + decimal(*figures.psnr, 2) +
               " dB</title></circle>\n";
    }

    const std::vector<const BatchRow*>& rows_;
    Range bytes_, psnr_;
};

}  // namespace

std::string batch_scatter(const std::vector<BatchRow>& rows) {
    std::vector<const BatchRow*> dots;
    for (const BatchRow& row : rows) {
        if (has_dot(row)) dots.push_back(&row);
    }
    return dots.empty() ? std::string() : Scatter(dots).svg();
}

}  // namespace gim

#include "tools/memory_budget.h"

#include <unistd.h>

#include <array>
#include <cstdio>

namespace gim {
namespace {

// "3.2 GB". Takes a double, because a product of two claims may exceed 64 bits.
std::string in_words(double bytes) {
    constexpr std::array<const char*, 5> kUnits = {"bytes", "KB", "MB", "GB", "TB"};
    size_t unit = 0;
    while (bytes >= 1024 && unit + 1 < kUnits.size()) {
        bytes /= 1024;
        ++unit;
    }
    char text[40];
    std::snprintf(text, sizeof(text), bytes < 10 && unit > 0 ? "%.1f %s" : "%.0f %s", bytes, kUnits[unit]);
    return text;
}

}  // namespace

uint64_t default_max_memory() {
    const long pages = ::sysconf(_SC_PHYS_PAGES);
    const long page_size = ::sysconf(_SC_PAGESIZE);
    if (pages <= 0 || page_size <= 0) return uint64_t{2} << 30;
    return static_cast<uint64_t>(pages) * static_cast<uint64_t>(page_size) / 2;
}

Result<void> MemoryBudget::take(uint64_t count, uint64_t bytes_each, std::string_view what) {
    if (bytes_each == 0 || count <= left() / bytes_each) {
        taken_ += count * bytes_each;
        return {};
    }
    const double needed = static_cast<double>(count) * static_cast<double>(bytes_each);
    return over_limit(std::string(what) + " take " + in_words(static_cast<double>(taken_) + needed) + " of memory");
}

Error MemoryBudget::over_limit(const std::string& what) const {
    return {Stage::kInput, what + ", more than the " + in_words(static_cast<double>(limit_)) +
                               " that --max-memory allows; if the machine has more, give a larger --max-memory"};
}

}  // namespace gim

// A file under a temporary name, until it is complete.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "tools/descriptor.h"
#include "tools/file.h"
#include "tools/removal.h"

namespace gim {

// Says what failed, why, and what to do about that reason. error: a value of errno.
Error cannot_write(int error);

class PartialFile {
  public:
    // Opens a new file in the folder of `target`. What a kill leaves says what it is: .NAME.gim-partial-XXXXXX.
    static Result<std::unique_ptr<PartialFile>> beside(std::filesystem::path target);
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;
    ~PartialFile();  // removes the file unless it has its name

    // Writes all bytes of the file. It takes the permissions of an old target, and its owner as far as the system
    // allows.
    Result<void> write(std::span<const uint8_t> bytes);
    // Replaces the target.
    Result<void> take_name();
    // Keeps the file under its temporary name, which it returns. Whoever takes it over must rename it or remove it.
    std::string hand_over();

  private:
    PartialFile(std::filesystem::path target, std::string path)
        : target_(std::move(target)), path_(std::move(path)), removed_on_signal_(std::in_place, path_) {}

    std::filesystem::path target_;
    std::string path_;
    std::optional<RemovedOnSignal> removed_on_signal_;  // from before the file is made
    std::optional<Descriptor> file_;                    // open until it is written
    bool is_there_ = false;
};

// ".NAME.gim-partial-XXXXXX" -> "NAME"; nothing for other names. A long NAME may have been shortened.
std::optional<std::string> target_of_partial(const std::string& name);

// Removes what killed programs left of this target. No program may be writing it. Finds no names that were shortened.
void remove_partials_of(const std::filesystem::path& target);

bool write_all(int fd, std::span<const uint8_t> bytes);

}  // namespace gim

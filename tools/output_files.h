// The files that a command writes: all of them or none.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/file.h"
#include "tools/named_file.h"

namespace gim {

class PartialFile;

// True for streams and devices: they have no other name that could be exchanged for theirs.
bool is_written_in_place(const std::string& name);

class OutputFiles {
  public:
    OutputFiles();
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;
    ~OutputFiles();  // removes what is not committed

    // Writes the bytes to a temporary file beside the one that is named. Streams and devices only take the bytes.
    Result<void> stage(const std::string& name, Bytes bytes);

    // Writes streams and devices. Then gives all files their names. Returns the first failure.
    std::optional<FileError> commit();

  private:
    struct Stream {
        std::string name;
        Bytes bytes;
    };
    struct File {
        std::string name;
        std::unique_ptr<PartialFile> partial;
    };
    std::vector<Stream> streams_;
    std::vector<File> files_;
};

}  // namespace gim

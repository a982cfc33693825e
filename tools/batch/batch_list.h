// The inputs of a batch, and the names of their outputs.
#pragma once

#include <string>
#include <vector>

#include "tools/file.h"

namespace gim {

struct BatchItem {
    std::string path;  // the input, as the system finds it
    std::string name;  // relative and without "..": the output is NAME.gim in the output folder
};

// Reads a list of paths, one a line ("-": from standard input), or looks for meshes in a folder and below it. Empty
// lines and lines that begin with # do not count. Items are sorted by name, and each path is there once.
//
// A name is the path relative to the folder; of a list, the path as it stands there, without a leading "/" or "..", as
// tar does. It keeps its extension and depends on no other line, so a line that is added moves no other output. Only if
// two paths get one name, as ../a.ply and a.ply, the later one in order gets a number.
//
// A folder gives the files that are named as meshes. Pictures and arrays (.exr, .npz) may be anything, so they must be
// in a list. Hidden files, and folders behind symbolic links, do not count.
Result<std::vector<BatchItem>> list_batch(const std::string& inputs);

// Every `shards`-th item from item `shard` on, counted from 1. All shards together are the whole, each item once.
std::vector<BatchItem> shard_of(const std::vector<BatchItem>& items, uint32_t shard, uint32_t shards);

}  // namespace gim

// Test meshes that code makes, so that every machine has them. Ask for them by property.
//
//   for (const CorpusEntry& entry : corpus().valid().closed().genus(1)) check(entry.mesh(), entry.name);
//
// manifest.csv lists them with their expected topology. Meshes are built when asked for and are the same everywhere up
// to the last digits of sin and cos.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "corpus/generators.h"
#include "gim/encoder.h"

namespace gim::corpus {

struct CorpusEntry {
    std::string name;
    TriangleMesh (*make)();
    bool is_valid;  // an oriented 2-manifold without unreferenced vertices
    uint32_t components;
    uint32_t boundary_loops;
    int genus;          // summed over components; -1 if the mesh is broken
    std::string fault;  // what is wrong with a mesh that is not valid

    TriangleMesh mesh() const { return make(); }
};

class Corpus {
  public:
    explicit Corpus(std::vector<CorpusEntry> entries) : entries_(std::move(entries)) {}

    auto begin() const { return entries_.begin(); }
    auto end() const { return entries_.end(); }
    size_t size() const { return entries_.size(); }

    Corpus valid() const;
    Corpus broken() const;
    Corpus connected() const;  // valid, one component
    Corpus closed() const;     // valid, no boundary
    Corpus bounded() const;    // valid, with a boundary
    Corpus genus(int value) const;

    // Returns the entry of that name. An unknown name is the caller's mistake: the entry's name is then empty.
    CorpusEntry named(const std::string& name) const;

  private:
    std::vector<CorpusEntry> entries_;
};

// The whole corpus. Never empty.
Corpus corpus();

}  // namespace gim::corpus

#include "corpus/corpus.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace gim::corpus {
namespace {

TEST(Corpus, EveryKindOfMeshIsThere) {
    EXPECT_GE(corpus().valid().closed().genus(0).size(), 5u);
    for (int genus = 1; genus <= 3; ++genus) EXPECT_GE(corpus().connected().closed().genus(genus).size(), 1u) << genus;
    EXPECT_GE(corpus().bounded().size(), 5u);
    EXPECT_GE(corpus().broken().size(), 5u);
}

TEST(Corpus, ValidMeshesHaveTheTopologyThatTheListPromises) {
    for (const CorpusEntry& entry : corpus().valid()) {
        const TopologySummary s = summarize_topology(entry.mesh());
        EXPECT_TRUE(s.manifold) << entry.name;
        EXPECT_EQ(s.components, entry.components) << entry.name;
        EXPECT_EQ(s.boundary_loops, entry.boundary_loops) << entry.name;
        EXPECT_EQ(s.genus, entry.genus) << entry.name;
        EXPECT_EQ(s.vertices, entry.mesh().positions.size()) << entry.name;
    }
}

TEST(Corpus, ClosedMeshesFaceOutwards) {
    for (const CorpusEntry& entry : corpus().connected().closed()) {
        const TriangleMesh mesh = entry.mesh();
        double volume = 0;
        for (const auto& t : mesh.triangles) {
            const auto &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
            volume += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                      a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
        EXPECT_GT(volume, 0) << entry.name;
    }
}

TEST(Corpus, SizesGoFromAHundredToTwentyThousandTriangles) {
    size_t smallest = SIZE_MAX, largest = 0;
    for (const CorpusEntry& entry : corpus().connected()) {
        const size_t count = entry.mesh().triangles.size();
        smallest = std::min(smallest, count);
        largest = std::max(largest, count);
    }
    EXPECT_LT(smallest, 200u);
    EXPECT_GT(largest, 15000u);
    EXPECT_LE(largest, 30000u);
}

TEST(Corpus, DenseMeshesHaveTheSameTopologyAndRounderFaces) {
    const uint32_t parts = 5;
    const TriangleMesh coarse = sphere(6), dense = densified(coarse, parts);
    EXPECT_EQ(dense.triangles.size(), parts * parts * coarse.triangles.size());
    const TopologySummary s = summarize_topology(dense);
    EXPECT_TRUE(s.watertight);
    EXPECT_EQ(s.genus, 0);
    EXPECT_EQ(s.vertices, dense.positions.size());
    const TriangleMesh fine = sphere(60);
    const double of_coarse = compare(fine, coarse, {.samples = 20000}).value().psnr;
    EXPECT_GT(compare(fine, dense, {.samples = 20000}).value().psnr, of_coarse + 6);
}

TEST(Corpus, DenseMeshesKeepBoundaries) {
    const TopologySummary s = summarize_topology(densified(annulus(6, 24, 0.4), 4));
    EXPECT_TRUE(s.manifold);
    EXPECT_EQ(s.boundary_loops, 2U);
    EXPECT_EQ(s.euler, 0);
}

TEST(Corpus, ManifestListsWhatIsThere) {
    std::ifstream file(std::string(GIM_SOURCE_DIR) + "/corpus/manifest.csv");
    ASSERT_TRUE(file);
    std::string line;
    std::getline(file, line);
    for (const CorpusEntry& entry : corpus()) {
        const TriangleMesh mesh = entry.mesh();
        std::ostringstream expected;
        expected << entry.name << ',' << mesh.positions.size() << ',' << mesh.triangles.size() << ','
                 << entry.components << ',' << entry.boundary_loops << ',';
        if (entry.genus >= 0) expected << entry.genus;
        expected << ',' << entry.fault;
        ASSERT_TRUE(std::getline(file, line)) << "missing: " << expected.str();
        EXPECT_EQ(line, expected.str());
    }
    EXPECT_FALSE(std::getline(file, line)) << "left over: " << line;
}

}  // namespace
}  // namespace gim::corpus

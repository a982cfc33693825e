// Sample density that follows the shape: how much each part of the surface should count in the stretch energy.
//
// After: Sander, Gortler, Snyder, Hoppe. Signal-Specialized Parametrization. EGRW 2002. We differ in how the need is found: not
// from derivatives of the signal, which a scanned mesh does not have, but from the error that a first sampling leaves. With
// linear reconstruction the squared error falls with the square of the density, e^2 = C / density^2, and the least total
// error for a given number of samples has density ~ C^(1/3). The stretch energy with weight w is least at density ~ w^(1/2).
#pragma once

#include <vector>

#include "encoder/charts/atlas.h"
#include "encoder/image/geometry_image.h"
#include "encoder/surface/mesh.h"

namespace gim {

struct DensityOptions {
    double strength = 0.8;  // 0: even samples, 1: the optimum of the model above; less is safer, as the model is rough
    double contrast = 50;   // the need is clamped to this factor around its median
    int smoothing = 30;     // averaging steps over neighbours
};

// In:  the opened mesh, its map, and the image sampled with that map.
// Out: per vertex the importance for ParametrizeOptions. Cost: one closest point a vertex, on all cores.
std::vector<double> importance_from_error(const Mesh& mesh, const std::vector<Vec2>& uv, const GeometryImage& image,
                                          const DensityOptions& options);

// The same for charts: maps them again, denser where evenly sampled charts err, if so many samples then err less. They need
// not be packed for it, as every chart is sampled by itself. A chart whose new border would run over itself keeps its map.
// Out: per face of the surface the importance that was used; empty, with the atlas untouched, where none was.
// Cost: one more parametrization, and two closest points a vertex.
Result<std::vector<double>> adapt_charts(const Mesh& mesh, uint32_t samples, const DensityOptions& options,
                                         const ChartParametrizeOptions& parametrize, Atlas& atlas,
                                         const Progress& progress = {});

// For images whose details are coded sparsely, squares: bytes at 65 and 70 dB fall by 2 to 4 % on bunny, and by less or not at
// all on feline, against the default, which is the best for images that are coded without loss.
inline constexpr DensityOptions kCodedDensity{.strength = 1.1, .contrast = 200, .smoothing = 30};

// Which options that takes: measured after a loose fit (horse, feline, dragon, gargoyle: +0.9 to +1.4 dB over even samples;
// full strength or less smoothing gains as much on three of them and loses on the fourth).
inline constexpr DensityOptions kChartDensity{.strength = 0.9, .contrast = 200, .smoothing = 15};

}  // namespace gim

// Where the coefficient coder starts: fitted weights of the expected magnitude, and model states that tools/train has
// learnt from development models.  spec/gim-format.md, "Values" and "Trained states", prints the same numbers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/bit_model.h"

namespace gim {

enum class CoefficientKind : uint8_t {
    kPlain,     // x, y, z: lossless positions
    kInFrames,  // a normal component and two tangential ones: lossy positions
    kPlanes,    // attribute planes
};

// What each magnitude nearby adds to the expected one, in 1/256 of it.
struct BandWeights {
    uint32_t left, above, corners;   // in the same band; corners: above left and above right
    uint32_t parent, beside_parent;  // beside_parent: its four neighbours
    uint32_t horizontal, vertical;   // those bands of the same level, at each sample around
    uint32_t cross;                  // later components of the triples left and above, but not of the same component
    uint32_t first, second;          // components of the same triple
    uint32_t constant;
};

// Bands of images narrower than this have the coarse weights.
inline constexpr uint32_t kFineSide = 32;

// For the first component and for later ones.
inline constexpr BandWeights kBaseWeights[2] = {
    {80, 48, 0, 0, 0, 0, 0, 0, 0, 0, 131072},
    {80, 48, 0, 0, 0, 0, 0, 0, 96, 48, 131072},
};

// By kind; coarse or fine; horizontal, vertical or diagonal; first or later component.
inline constexpr BandWeights kBandWeights[3][2][3][2] = {
    {
        {
            {{8, 35, 0, 22, 0, 0, 0, 6, 0, 0, 16915}, {20, 41, 0, 19, 2, 0, 0, 7, 95, 53, 3700}},
            {{11, 22, 0, 22, 1, 37, 0, 13, 0, 0, 2761}, {18, 17, 0, 19, 2, 25, 0, 3, 75, 48, 1}},
            {{0, 14, 1, 14, 0, 37, 32, 11, 0, 0, 1}, {14, 21, 1, 8, 1, 19, 20, 1, 66, 19, 0}},
        },
        {
            {{19, 39, 10, 27, 5, 0, 0, 6, 0, 0, 32}, {20, 35, 10, 23, 3, 0, 0, 2, 40, 26, 30}},
            {{44, 15, 10, 24, 3, 12, 0, 3, 0, 0, 17}, {43, 14, 9, 21, 2, 10, 0, 1, 34, 21, 16}},
            {{13, 13, 10, 9, 1, 20, 30, 2, 0, 0, 25}, {11, 12, 8, 8, 1, 17, 27, 2, 25, 15, 22}},
        },
    },
    {
        {
            {{15, 40, 0, 9, 0, 0, 0, 50, 0, 0, 24995}, {40, 46, 0, 5, 1, 0, 0, 9, 35, 63, 101}},
            {{30, 33, 0, 7, 1, 50, 0, 74, 0, 0, 0}, {40, 31, 1, 7, 1, 15, 0, 5, 20, 31, 0}},
            {{12, 27, 3, 1, 2, 13, 15, 53, 0, 0, 1}, {14, 26, 12, 0, 0, 12, 9, 8, 11, 44, 0}},
        },
        {
            {{57, 62, 17, 6, 2, 0, 0, 49, 0, 0, 1}, {32, 75, 7, 5, 1, 0, 0, 12, 5, 3, 0}},
            {{61, 55, 22, 5, 1, 3, 0, 47, 0, 0, 0}, {55, 40, 15, 3, 1, 1, 0, 2, 4, 26, 0}},
            {{37, 38, 19, 5, 0, 6, 5, 25, 0, 0, 1}, {26, 25, 20, 3, 0, 2, 6, 3, 3, 17, 0}},
        },
    },
    {
        {
            {{48, 40, 0, 20, 0, 0, 0, 14, 0, 0, 1464}, {57, 38, 9, 25, 6, 0, 0, 4, 32, 34, 0}},
            {{44, 66, 1, 15, 7, 29, 0, 1, 0, 0, 0}, {42, 44, 2, 20, 6, 29, 0, 0, 0, 18, 0}},
            {{26, 1, 19, 5, 0, 24, 31, 4, 0, 0, 0}, {7, 7, 25, 12, 0, 20, 26, 0, 0, 15, 0}},
        },
        {
            {{48, 64, 18, 14, 2, 0, 0, 7, 0, 0, 1}, {42, 58, 18, 8, 2, 0, 0, 2, 13, 47, 0}},
            {{78, 32, 12, 14, 1, 11, 0, 6, 0, 0, 0}, {77, 41, 13, 8, 1, 6, 0, 1, 8, 37, 0}},
            {{19, 12, 10, 6, 0, 25, 19, 4, 0, 0, 0}, {28, 16, 17, 4, 0, 16, 12, 0, 9, 38, 0}},
        },
    },
};

// Two characters per model: age_code * 32 + probability_code, as hexadecimal digits, in the order of BandModels.
inline constexpr const char* kTrainedModels[3] = {
    "1010101b1010101a1010101f1010101010101010101010101010101010101010101010101010101010101010101010101010101010"
    "108b890b1010101010101010101010acc70910101010101010101010108de8051010101010101010101010aee9ca4d100e10101010"
    "10101010cfeae98c0f5110120e1010101010d0ebebac8f3010100e1010101010d0edecedce8f4f9011521515150bf1eeedeecfb0b0"
    "90917170947015d2efefeff0f0d0f1d0b150919218f3f0f0f0f0d1d1d1f1d191d19151f4f2f1f1f1f2f2f2f2f2f2d2f3f3f5f3f3f2"
    "f2f2f2f3f3f2f3f2f2f2f2f2f2f2f2f2f2f2f2f2f2f2f3d3f3f3f2f3f3d2f2f3f2f3f2f3f3f3101010101010101010101010101010"
    "101010101010101010101010101010101010101010101010101010cbc7091010101010101010101010ace74b0e1010101010101010"
    "1010cec8670e10101010101010101010aee9870b10101010101010101010efeae9ad07101010101010101010d0ebebac2b9050120e"
    "1010101010f1edecedcd8e4e904f120e101010f1eeedceefcfcf9073918f0f1212d2f0cfefefeff0b0b0b2b1919291f3f1f0f0f0f0"
    "f0d1d1f2f1b19190f4f2d1f1f1f1f1d1f2f1f1f2f2d2f5f3f3f2f2f2f2f2f2f3f2f2f2f2f3f2f2f1f1f1f1f1f2f1f1f2f2b1f4f3f3"
    "f3f3f2f2f2f2f2f2f2d2f2101010101010101010101010101010101010101010101010101010101010101010101010101010101010"
    "10101010101010101010101010101010101010101010101010101010aca70c1010101010101010101010cdc70c0e10101010101010"
    "101010eee9c80e0e101010101010101010cfeaea8c100c1010101010101010d0ccebcdcd4f92100d1010101010f1edcdedcdaf9011"
    "548e140c1010f2efeeeeceefcfb08e51104f1012f3f0eff0f0f0f0f0d08f708d1010f4f2f1f1f1f1f1f1f1f1b1d2d1d2f5f3f2f2f2"
    "f2f2f2f2f2f2f2f1d2f2f2f1f1f1f1f1f1f1d1d1d2d1d2f3f3f3f2f2f2f2f2f2f2f2d2d2b310101010101010101010101010101010"
    "101010101010101010101010101010101010f3d1ef8d4b0a1010101010101010101010101010101010101010101010101010eeedf1"
    "ededf1efeef1eeedf0eeeef1efedf0efeff2efeff2efeef2ececf0ececf0eeeef2ecedf0ededf1afeff2ededf1ededf0cecef2eeef"
    "efeeefefefefefeeefefedf0f0cfeff0efefefeff0f0cfefefeeedf1eeeef1f0eef1eeedf0eeeef1cfedf0efeef2f0eff3f0cef2ec"
    "ecf0ededf0eeeed2cdedf1eeeef1efeff2eeedf1eeedf0efeff2eeefefeeeff0efefefeeeff0eef0f0eff0f0efefefcff0f0f0efef",
    "e2c5c5eee8cbecf0edf0f1f6e6cccd0b0e101010101010101010e88d8d8e0f10100e101010101010e9adad2f2d130d101010101010"
    "10e9adac8e8f0a1010101010101010eacecece308e0f12121212120e10ebceee4e4f314d14100e10101010ebeeee8f8f904f12150f"
    "0e101010ecefefefd0b06f5110100c101010edefefefd0d03091109430521013eef0f0eff0d1d0b1517333541152eff1f0f0f1f1d1"
    "d1919152101251f0f2f1f1f1f1f172d1d2d1521352f1f2f2f2f1f2f2f2d2d273d29233f1f3f3f3f3f3f3f2f3f3d2b3d3d4f2f4f4f3"
    "f3f3f3f3f3f3f3f4d3d3f2f2f2f2f2f2f2f2f2d2d3b393d4f2f3f3f3f3f3f3f3f3f3b394f4f4aecb4f8f115010120e1010101010f0"
    "ec8e8f8f100c101010101010108fcd8f0e110a1010101010101010f0ed8e4f101313100c1010101010f0eeaf6f7010904f0e101010"
    "1010f0efd08f90911010124e0e101010b1afd0cf308f8f100c1010101010d1eff0d0d150513031919010100ed1f0f1d1d1d0717091"
    "1293111652f1f1f1f1d171d151929213968f50f1f2f2d1f292b2d2937193539192d1f2f2f2d2d2d17292d372519292f2f4f4f3f3d2"
    "f352d19352739393f2f4d4f4f4f3b3d3d29253b2b492f3f5f5f4f4f3b4d4d3b3b3d39391f3f3f2f2f2f2f2d2f2d354b37437f3f4f3"
    "f3f3f2f3b3f3b394b3d4d3880a1010101010101010101010108a07101010101010101010101010850c101010101010101010101010"
    "aa0c4f120e101010101010101010c98b0c1010101010101010101010cc2d8c111414100e101010101010cccd8e100f0e1010101010"
    "101010ed8eaf90900d0e10101010101010ce703051900f10101212120e1010ee90d191900f93114d0e10101010ef71b1b1b2903010"
    "135015111012f0f2d2b2d292b173915053121713f0f3d394b2d293b2127250121313f0f4f3f373b3939293b39291949491d5d4d4f4"
    "b4d373d352b3939492f2f2f2f2f2f1b2d1d29291915212f2f3f3f2f2f2f2d2b2b293543232e410e7e5e8e8e8e8e9e9eaeaebebecec"
    "ededeeeeeecfefefb0f0d1f1d1d1d3f795f7f3f2f0ef9010110f100c10101010101010101010101010101010101010101010f0eef2"
    "f3f0f4cdebaeceeccfd1eed1ebebedd2f1f3d4f2f48fedd0f0eef2ceecefd291f393f1f4d1eef2d6f2f56debafeaebec8eee50f0f0"
    "f0d3b1f3cececed291d293d2f3d07050cdeeaf70b0b04cce8df0eef272f1d2d0ceefce8ef031d0718fceafd2f19293d1f2b5ef90f0"
    "eef2aeadf0d0909233d1f312cf3095d293cfedef8becef90afb0f0f0d112b1f16dceef32d3f19791b20fcfd12eafcf7290af8dcdad",
    "88038990ac8d4ed18f1272f7e6a94e0e10101010101010101010e849091010101010101010101010e8880b10101010101010101010"
    "10eaa9071010101010101010101010eaca8b0b10101010101010101010ecaa4d8c0e101010101010101010ecacad8e50110c101010"
    "10101010edeccd8c4d0e1010101010101010ceed8d8e2f8e10120e1010101010f0eececfaeaf70900a1010101010f1eeefd0cfd0b0"
    "b0919290101212f2f0f0d0d0f0cfb1b3737591510ef3f0f1d0d1d2d150b17171909152f4f2f2f2f2d2b2d2d291b191b453f5f3f3b2"
    "f3b3f392d4b2b35294b271d1f2f2f2f2b2f2d2d292b455b3b231d2f2d271f2b252319293b3b167870c1010101010101010101010c7"
    "670a1010101010101010101010c8260e1010101010101010101010aae7091010101010101010101010cae88a0e1010101010101010"
    "1010abea4c0910101010101010101010cceb8c8e0b101010101010101010cdebccae6e0c1010101010101010eeecacad0f8e0e1010"
    "1010101010efedcecece2c0b10101010101010f1ceeeafce91af92321010121212f2f0d0f0d1d1d090b05130501012f3f1f1d1d1d1"
    "d290919130916e50f4f2f2d2d2f2d2b231b2b2b29391f5f3b3f3f3b35294d3d4d39394b4f2f2f2f2d292d2b3d2b3b3339152d3f4f3"
    "d3d3b2b1d3d3b272729293101010101010101010101010101010101010101010101010101010100b0e101010101010101010101010"
    "07101010101010101010101010100710101010101010101010101010aa061010101010101010101010104ca88e0e10101010101010"
    "1010104dea0610101010101010101010108eeaab0a10101010101010101010afeccc4b100e1010101010101010b0eecd8d0f8d120e"
    "10101010101071f0cfefafae0c0e10101010101031b0d0d0d0309090309010121212b4d2d2f1d0d1b2b050903052101053d3d2f2d2"
    "d2d39391b09190333010f2d2d1f1d1b1b2b19251729251f3d2d2d3d2f2b2b3b2b37493929310101010101010101010101010101010"
    "101010101010101010101010101010101010f3b2cf8f9010150f0e1010101010101010101010101010101010101010101010f0f0f1"
    "91f2d28deeed6feff052d2f18ccdee90d0d19292d36cedeef0eff14feff091f0d192f2f391d2d192f2d3accdeeaeeeefaeceeed0f0"
    "f091b2f1aecfcfb291d171b2d14eb0afb0cff0afd0d18fce8ff0eff0b2f2928dedef8fafd0929172ceedcd91d1d152b2538eee6ff0"
    "eff1cfeff0d0f0f154f3f3b2f2f294b2d3adedeead8eee8eceeed0f0f071d1b1ceefaf72d1b1b1d1f211d0ae8faeaeb1d1d0adcfaf",
};

// Probability of a zero in 1/65536: 1 / (1 + e^(0.4 (code - 16))), rounded down, at least 200 and at most 65336.
inline constexpr uint16_t kStartProbabilities[32] = {
    65336, 65336, 65294, 65176, 65001, 64741, 64357, 63792, 62969, 61779, 60085, 57723, 54527, 50366, 45218, 39235,
    32768, 26300, 20317, 15169, 11008, 7812,  5450,  3756,  2566,  1743,  1178,  794,   534,   359,   241,   200};
inline constexpr uint8_t kStartAges[8] = {0, 1, 2, 4, 7, 12, 24, 60};

constexpr uint32_t hexadecimal_digit(char c) { return static_cast<uint32_t>(c <= '9' ? c - '0' : c - 'a' + 10); }

constexpr BitModel trained_model(const char* code) {
    const uint32_t value = hexadecimal_digit(code[0]) * 16 + hexadecimal_digit(code[1]);
    return {kStartProbabilities[value & 31], kStartAges[value >> 5]};
}

}  // namespace gim

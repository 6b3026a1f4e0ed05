// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hone/core/math.h"

#include <algorithm>
#include <array>

namespace hone {

/// The order in which pixels of one set are traced: in tiles of kTile x kTile pixels, tiles row by
/// row, Z-order inside a tile (Morton 1966). Neighbours in the list are then neighbours in the
/// image in both directions, which packets of rays need, also when the set is sparse.
///
/// Two numbers name a pixel's place: its `key` (any width and height; has gaps where the last tiles
/// stick out of the image) and its `rank` (0 to width * height - 1, no gaps). Both grow in tile
/// order. Along one row of pixels tile order is left to right.
class TileOrder {
public:
    static constexpr uint kTileBits = 5;
    static constexpr uint kTile = 1u << kTileBits;
    static constexpr uint kTilePixels = kTile * kTile;

    /// `extent`: of the image, at least 1 x 1.
    explicit TileOrder(uvec2 extent)
        : extent_(extent), tiles_((extent.x + kTile - 1) / kTile, (extent.y + kTile - 1) / kTile) {
        for (uint code = 0; code < kTilePixels; ++code) {
            const uvec2 inside = deinterleave(code);
            offsets_[code] = inside.y * extent.x + inside.x;
        }
    }

    [[nodiscard]] uvec2 extent() const { return extent_; }
    [[nodiscard]] uvec2 tiles() const { return tiles_; } ///< columns and rows of tiles
    [[nodiscard]] uint keyCount() const { return tiles_.x * tiles_.y * kTilePixels; }

    /// `pixel`: y * width + x.
    [[nodiscard]] uint key(uint pixel) const {
        const uint x = pixel % extent_.x;
        const uint y = pixel / extent_.x;
        const uint tile = (y >> kTileBits) * tiles_.x + (x >> kTileBits);
        return tile << (2 * kTileBits) | interleave({x & (kTile - 1), y & (kTile - 1)});
    }
    /// The pixel of a key that key() gave.
    [[nodiscard]] uint pixelOfKey(uint key) const {
        return firstPixel(key >> (2 * kTileBits)) + offsets_[key & (kTilePixels - 1)];
    }

    /// Rank of the first pixel of a tile, counted row by row; tiles().x * tiles().y gives the
    /// number of pixels.
    [[nodiscard]] uint firstRank(uint tile) const {
        const uint row = std::min(tile / tiles_.x * kTile, extent_.y);
        const uint column = tile % tiles_.x * kTile;
        return row * extent_.x + column * std::min(kTile, extent_.y - row);
    }
    /// The tile that the pixel of this rank lies in.
    [[nodiscard]] uint tileOfRank(uint rank) const {
        const uint row = rank / extent_.x / kTile;
        const uint height = std::min(kTile, extent_.y - row * kTile);
        return row * tiles_.x + (rank - row * kTile * extent_.x) / (kTile * height);
    }

    /// Calls visit(pixel) for the pixels of a tile in tile order.
    template <class Visit> void forEachPixel(uint tile, Visit&& visit) const {
        const uint first = firstPixel(tile);
        const uint width = std::min(kTile, extent_.x - tile % tiles_.x * kTile);
        const uint height = std::min(kTile, extent_.y - tile / tiles_.x * kTile);
        if (width == kTile && height == kTile) {
            for (uint offset : offsets_)
                visit(first + offset);
            return;
        }
        for (uint code = 0; code < kTilePixels; ++code) {
            const uvec2 inside = deinterleave(code);
            if (inside.x < width && inside.y < height)
                visit(first + offsets_[code]);
        }
    }

private:
    [[nodiscard]] uint firstPixel(uint tile) const {
        return tile / tiles_.x * kTile * extent_.x + tile % tiles_.x * kTile;
    }
    /// x and y below 256, bit by bit, x in the even bits.
    static constexpr uint interleave(uvec2 inside) {
        uint code = inside.x | inside.y << 16;
        code = (code | code << 4) & 0x0f0f0f0fu;
        code = (code | code << 2) & 0x33333333u;
        code = (code | code << 1) & 0x55555555u;
        return (code & 0xffffu) | code >> 15;
    }
    static constexpr uvec2 deinterleave(uint code) {
        uint both = (code & 0x5555u) | (code & 0xaaaau) << 15;
        both = (both | both >> 1) & 0x33333333u;
        both = (both | both >> 2) & 0x0f0f0f0fu;
        both = (both | both >> 4) & 0x00ff00ffu;
        return {both & 0xffffu, both >> 16};
    }

    uvec2 extent_;
    uvec2 tiles_;
    std::array<uint, kTilePixels> offsets_{}; ///< pixel minus the tile's first, by Z-order code
};

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// request: takes the next batch of pixels to trace.
//
// Each execution lists the next `batch` pixels of the order, in tile order, as packets of rays want
// them. Once every pixel had its turn it begins again with the following samples, until all
// `samples` are requested; then the list is empty. Sample numbers, not time, say what is traced, so
// the final image depends neither on the order nor on the batch.
//
// in   order  PixelList (optional): whom to trace first; without it all pixels in tile order
// in   state  Cursor (optional): how many batches were taken; without it begins at the first
// in   error  Error (optional): only tells counter worst_expect_bits, for progress and curves
// out  requests  RequestList: (pixel, first sample, sample count)
// out  state  Cursor, in place
// params  batch      pixels in a batch (8192); 0 = all
//         samples    samples per pixel when finished (1)
//         per_visit  samples per pixel in one batch; 0 = all of them at once
// counters  pixels  requested, again in each visit
//           worst_expect_bits  greatest expected error of the batch, as the bits of a float
//
//     "request": { "type": "request", "in": { "order": "sort.order", "state": "~state" },
//                  "params": { "batch": "$batch", "samples": "$samples" } }
//
// Source: Amann, Chajdas, Westermann 2012, section 3.5 (requests for the worst pixels first).
#include "hone/core/image/tile_order.h"
#include "hone/passes/passes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

namespace hone {
namespace {

class RequestPass final : public RenderPass {
public:
    void execute(PassContext& context) override {
        const TileOrder tiles(context.extent);
        const std::size_t pixels = std::size_t{context.extent.x} * context.extent.y;
        const std::size_t listed = context.has("order") ? context.in("order").count : pixels;
        uint& batches_taken = context.out("state").as<uint>().front();
        Value& out = context.out("requests");
        out.count = 0;

        // Where the cursor stands: which visit, which batch of it.
        const uint wanted = context.param<uint>("batch");
        const std::size_t batch = wanted == 0 ? pixels : wanted;
        const std::size_t batches = (listed + batch - 1) / batch;
        const uint samples = context.param<uint>("samples");
        const uint per_visit = context.param<uint>("per_visit");
        const uint visit_samples = per_visit == 0 ? samples : std::min(per_visit, samples);
        if (batches == 0 || batches_taken / batches * visit_samples >= samples)
            return;
        const uint first_sample = static_cast<uint>(batches_taken / batches) * visit_samples;
        const uint sample_count = std::min(visit_samples, samples - first_sample);
        const std::size_t begin = batches_taken % batches * batch;
        const std::size_t count = std::min(batch, listed - begin);

        const std::span<uvec3> requests = out.capacity<uvec3>().first(count);
        const uvec3 request(0, first_sample, sample_count);
        if (context.has("order"))
            requestListed(tiles, context.in("order").as<uint>().subspan(begin, count), request,
                          requests);
        else
            requestRanks(tiles, begin, request, requests);
        out.count = static_cast<uint>(count);
        ++batches_taken;
        context.counters->add("pixels", count);
        if (context.has("error"))
            context.counters->set(
                "worst_expect_bits",
                std::bit_cast<uint>(worstExpect(context.in("error").as<vec2>(), requests)));
    }

private:
    static float worstExpect(std::span<const vec2> error, std::span<const uvec3> requests) {
        float worst = 0;
        for (const uvec3& request : requests)
            worst = std::max(worst, error[request.x].x);
        return worst;
    }

    /// The pixels of the list, each of which is in it once, in tile order.
    void requestListed(const TileOrder& tiles, std::span<const uint> pixels, uvec3 request,
                       std::span<uvec3> requests) {
        if (copyWhileInOrder(tiles, pixels, request, requests))
            return;
        // A bit for each place in tile order sorts them.
        is_requested_.assign((tiles.keyCount() + 63) / 64, 0);
        for (uint pixel : pixels) {
            const uint key = tiles.key(pixel);
            is_requested_[key / 64] |= std::uint64_t{1} << (key % 64);
        }
        std::size_t next = 0;
        for (std::size_t word = 0; word < is_requested_.size(); ++word)
            for (std::uint64_t bits = is_requested_[word]; bits != 0; bits &= bits - 1) {
                request.x = tiles.pixelOfKey(
                    static_cast<uint>(word * 64 + static_cast<uint>(std::countr_zero(bits))));
                requests[next++] = request;
            }
    }

    /// False when the list is not in tile order, as that of sort's strategy radix.
    static bool copyWhileInOrder(const TileOrder& tiles, std::span<const uint> pixels,
                                 uvec3 request, std::span<uvec3> requests) {
        uint next_key = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const uint key = tiles.key(pixels[i]);
            if (key < next_key)
                return false;
            next_key = key + 1;
            request.x = pixels[i];
            requests[i] = request;
        }
        return true;
    }

    /// The pixels of ranks begin, begin + 1, ... in tile order.
    static void requestRanks(const TileOrder& tiles, std::size_t begin, uvec3 request,
                             std::span<uvec3> requests) {
        const auto first = static_cast<uint>(begin);
        const uint last = first + static_cast<uint>(requests.size()) - 1;
        tbb::parallel_for(tiles.tileOfRank(first), tiles.tileOfRank(last) + 1, [&](uint tile) {
            uint rank = tiles.firstRank(tile);
            uvec3 mine = request;
            tiles.forEachPixel(tile, [&](uint pixel) {
                if (rank >= first && rank <= last) {
                    mine.x = pixel;
                    requests[rank - first] = mine;
                }
                ++rank;
            });
        });
    }

    std::vector<std::uint64_t> is_requested_; ///< by key
};

std::size_t batchSize(const SizeQuery& query) {
    const std::size_t pixels = std::size_t{query.extent.x} * query.extent.y;
    const uint batch = query.params.get<uint>("batch");
    return batch == 0 ? pixels : std::min<std::size_t>(batch, pixels);
}

} // namespace

PassType requestPass() {
    return PassType("request", "Takes the next batch of pixels to trace")
        .inOptional("order", types::kPixelList, "whom to trace first; none: all, in tile order")
        .inOptional("state", types::kCursor, "how many batches were taken; none: begins anew")
        .inOptional("error", types::kError, "what progress shows; changes no request")
        .out("requests", types::kRequestList, "the batch, in tile order; empty when all is done",
             batchSize)
        .outInPlace("state", types::kCursor, "state", "one batch further",
                    [](const SizeQuery&) { return std::size_t{1}; })
        .param("batch", 8192u, {.min = 0, .max = {}}, "pixels in a batch; 0 = all")
        .param("samples", 1u, {.min = 1, .max = {}}, "samples per pixel when finished")
        .param("per_visit", 0u, {.min = 0, .max = {}},
               "samples per pixel in one batch; 0 = all of them at once")
        .implementedBy<RequestPass>(Domain::kHost);
}

} // namespace hone

// SPDX-License-Identifier: Apache-2.0
//
// Untrusted models: each case is the valid square with one thing wrong, and must be refused with
// the file's name, the place and the reason.
#include "hone/tests/core/scene/small_gltf.h"

#include <functional>
#include <limits>

namespace hone {
namespace {

struct Malformed {
    const char* name;
    std::function<void(SmallGltf&)> damage;
    std::vector<std::string> says;
};

void PrintTo(const Malformed& malformed, std::ostream* out) {
    *out << malformed.name;
}

class MalformedGltf : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedGltf, IsRefusedWithFilePlaceAndReason) {
    const ScratchFolder folder;
    SmallGltf model;
    GetParam().damage(model);
    const std::string path = model.write(folder);
    const std::string error = loadError(path);
    EXPECT_NE(error.find(path), std::string::npos) << error;
    for (const std::string& words : GetParam().says)
        EXPECT_NE(error.find(words), std::string::npos) << error << "\nlacks: " << words;
}

/// One accessor more, for positions of which one is replaced.
nlohmann::json sparse(int index_view, int value_view, std::int64_t count) {
    return {{"count", count},
            {"indices", {{"bufferView", index_view}, {"componentType", 5123}}},
            {"values", {{"bufferView", value_view}}}};
}

const float kNan = std::numeric_limits<float>::quiet_NaN();

const Malformed kCases[] = {
    {"NoAsset", [](SmallGltf& m) { m.json.erase("asset"); }, {"/asset/version"}},
    {"Version1", [](SmallGltf& m) { m.json["asset"]["version"] = "1.0"; }, {"1.0; only glTF 2"}},
    {"RequiredExtension",
     [](SmallGltf& m) {
         m.json["extensionsRequired"] = {"KHR_materials_ior", "KHR_draco_mesh_compression"};
     },
     {"/extensionsRequired: KHR_draco_mesh_compression not supported"}},
    {"MeshesNoArray", [](SmallGltf& m) { m.json["meshes"] = 3; }, {"/meshes: expected an array"}},
    {"NodeNoObject",
     [](SmallGltf& m) { m.json["nodes"][0] = 3; },
     {"/nodes/0: expected an object"}},
    {"DeepJson",
     [](SmallGltf& m) {
         nlohmann::json deep = 1;
         for (int i = 0; i < 100; ++i)
             deep = nlohmann::json::array({deep});
         m.json["nodes"][0]["extras"] = deep;
     },
     {"nested deeper than 64"}},

    {"BufferTooShort",
     [](SmallGltf& m) { m.json["buffers"][0]["byteLength"] = 141; },
     {"/buffers/0/uri", "byteLength is 141, but there are only 140"}},
    {"BufferMissing",
     [](SmallGltf& m) { m.json["buffers"][0]["uri"] = "gone.bin"; },
     {"/buffers/0/uri \"gone.bin\": no such file"}},
    {"BufferWithoutUri",
     [](SmallGltf& m) { m.json["buffers"][0].erase("uri"); },
     {"/buffers/0", "no \"uri\""}},
    {"BufferEscapesFolder",
     [](SmallGltf& m) { m.json["buffers"][0]["uri"] = "../../etc/passwd"; },
     {"/buffers/0/uri \"../../etc/passwd\"", "outside the model's folder"}},
    {"BufferEscapesFolderEncoded",
     [](SmallGltf& m) { m.json["buffers"][0]["uri"] = "%2e%2e/%2e%2e/etc/passwd"; },
     {"outside the model's folder"}},
    {"BufferAbsolute",
     [](SmallGltf& m) { m.json["buffers"][0]["uri"] = "/etc/passwd"; },
     {"/buffers/0/uri \"/etc/passwd\"", "absolute"}},
    {"BufferHttp",
     [](SmallGltf& m) { m.json["buffers"][0]["uri"] = "http://example.com/a.bin"; },
     {"/buffers/0/uri", "only relative paths and data: URIs"}},
    {"BufferFileScheme",
     [](SmallGltf& m) { m.json["buffers"][0]["uri"] = "file:///etc/passwd"; },
     {"only relative paths and data: URIs"}},
    {"BufferIsFolder",
     [](SmallGltf& m) { m.json["buffers"][0]["uri"] = "./"; },
     {"/buffers/0/uri"}},
    {"BufferBadBase64",
     [](SmallGltf& m) {
         m.json["buffers"][0]["uri"] = "data:application/octet-stream;base64,AA$A";
     },
     {"/buffers/0/uri", "base64", "'$'"}},

    {"ViewPastBuffer",
     [](SmallGltf& m) { m.json["bufferViews"][0]["byteLength"] = 200; },
     {"/bufferViews/0", "reach past the 140 bytes of buffer 0"}},
    {"ViewOffsetPlusLengthWraps",
     [](SmallGltf& m) {
         m.json["bufferViews"][0]["byteOffset"] = 18446744073709551612u;
         m.json["bufferViews"][0]["byteLength"] = 48;
     },
     {"/bufferViews/0/byteOffset: 18446744073709551612"}},
    {"ViewOffsetHuge",
     [](SmallGltf& m) { m.json["bufferViews"][0]["byteOffset"] = 9007199254740992u; },
     {"/bufferViews/0", "reach past"}},
    {"ViewNegativeOffset",
     [](SmallGltf& m) { m.json["bufferViews"][0]["byteOffset"] = -4; },
     {"/bufferViews/0/byteOffset: -4"}},
    {"ViewOfNoBuffer",
     [](SmallGltf& m) { m.json["bufferViews"][0]["buffer"] = 7; },
     {"/bufferViews/0", "names buffer 7, but there are 1"}},

    {"AccessorPastView",
     [](SmallGltf& m) { m.json["accessors"][0]["count"] = 5; },
     {"/accessors/0/bufferView: 5 elements of 12 bytes", "past the 48 bytes of buffer view 0"}},
    {"AccessorCountMost",
     [](SmallGltf& m) { m.json["accessors"][0]["count"] = 0xffffffffu; },
     {"/accessors/0/bufferView: 4294967295 elements"}},
    {"AccessorCountWrapsTheProduct",
     [](SmallGltf& m) { m.json["accessors"][0]["count"] = 1537228672809129302u; },
     {"/accessors/0/count"}},
    {"AccessorCountZero",
     [](SmallGltf& m) { m.json["accessors"][0]["count"] = 0; },
     {"/accessors/0/count: 0"}},
    {"AccessorOffsetPastView",
     [](SmallGltf& m) { m.json["accessors"][0]["byteOffset"] = 40; },
     {"/accessors/0/bufferView", "from byte 40 on reach past"}},
    {"AccessorStrideReachesPastView",
     [](SmallGltf& m) { m.json["bufferViews"][0]["byteStride"] = 252; },
     {"/accessors/0/bufferView", "252 apart"}},
    {"AccessorStrideTooSmall",
     [](SmallGltf& m) { m.json["bufferViews"][0]["byteStride"] = 8; },
     {"/accessors/0/bufferView: byteStride 8 is less than its 12 bytes"}},
    {"AccessorStrideHuge",
     [](SmallGltf& m) { m.json["bufferViews"][0]["byteStride"] = 4294967296u; },
     {"/bufferViews/0/byteStride"}},
    {"AccessorOfNoView",
     [](SmallGltf& m) { m.json["accessors"][0]["bufferView"] = 9; },
     {"/accessors/0/bufferView: names buffer view 9, but there are 4"}},
    {"AccessorZerosWithoutEnd",
     [](SmallGltf& m) {
         m.json["accessors"][0].erase("bufferView");
         m.json["accessors"][0]["count"] = 4294967295u;
     },
     {"/accessors/0/count", "without a buffer view"}},
    {"AccessorWithoutCount",
     [](SmallGltf& m) { m.json["accessors"][0].erase("count"); },
     {"/accessors/0: has no \"count\""}},

    {"SparseIndexOutOfRange",
     [](SmallGltf& m) {
         const std::uint16_t index[] = {4};
         m.addAccessor(index, 5123, "SCALAR", 1);
         m.json["accessors"][0]["sparse"] = sparse(4, 1, 1);
     },
     {"/accessors/0/sparse/indices: index 4 is not below the 4 elements"}},
    {"SparseCountTooLarge",
     [](SmallGltf& m) { m.json["accessors"][0]["sparse"] = sparse(3, 1, 5); },
     {"/accessors/0/sparse/count: 5"}},
    {"SparseCountMost",
     [](SmallGltf& m) { m.json["accessors"][0]["sparse"] = sparse(3, 1, 0xffffffffll); },
     {"/accessors/0/sparse/count"}},
    {"SparseValuesPastView",
     [](SmallGltf& m) { m.json["accessors"][0]["sparse"] = sparse(3, 3, 2); },
     {"/accessors/0/sparse/values: 2 elements of 12 bytes"}},
    {"SparseIndicesOfFloats",
     [](SmallGltf& m) {
         m.json["accessors"][0]["sparse"] = sparse(3, 1, 1);
         m.json["accessors"][0]["sparse"]["indices"]["componentType"] = 5126;
     },
     {"/accessors/0/sparse/indices/componentType: 5126"}},

    {"IndexOutOfRange",
     [](SmallGltf& m) {
         const std::uint16_t indices[] = {0, 1, 2, 0, 2, 4};
         m.put(SmallGltf::kIndices, indices);
     },
     {"/accessors/3: index 4 at element 5 is not below the 4 vertices",
      "/meshes/0/primitives/0/indices"}},
    {"IndicesOfFloats",
     [](SmallGltf& m) { m.primitive()["indices"] = 0; },
     {"/accessors/0/type: expected SCALAR"}},
    {"IndicesSigned",
     [](SmallGltf& m) { m.json["accessors"][3]["componentType"] = 5122; },
     {"/accessors/3/componentType: 5122"}},
    {"IndicesNotWholeTriangles",
     [](SmallGltf& m) { m.json["accessors"][3]["count"] = 5; },
     {"/meshes/0/primitives/0/indices", "5 corners"}},
    {"PositionsOfIntegers",
     [](SmallGltf& m) { m.json["accessors"][0]["componentType"] = 5125; },
     {"/accessors/0/componentType: 5125; expected 5126"}},
    {"PositionsOfTwoComponents",
     [](SmallGltf& m) { m.json["accessors"][0]["type"] = "VEC2"; },
     {"/accessors/0/type: expected VEC3", "/attributes/POSITION"}},
    {"PositionsUnknownType",
     [](SmallGltf& m) { m.json["accessors"][0]["type"] = "VEC9"; },
     {"VEC9"}},
    {"PositionNan",
     [](SmallGltf& m) {
         const float value[] = {kNan};
         m.put(SmallGltf::kPositions + 12, value);
     },
     {"/accessors/0: position 1 is not finite"}},
    {"PositionMissing",
     [](SmallGltf& m) { m.primitive()["attributes"].erase("POSITION"); },
     {"/meshes/0/primitives/0/attributes: has no POSITION"}},
    {"AttributesMissing",
     [](SmallGltf& m) { m.primitive().erase("attributes"); },
     {"/meshes/0/primitives/0: has no \"attributes\""}},
    {"FewerNormalsThanPositions",
     [](SmallGltf& m) { m.json["accessors"][1]["count"] = 3; },
     {"/meshes/0/primitives/0/attributes/NORMAL: 3 normals for 4 positions"}},
    {"NoSuchAccessor",
     [](SmallGltf& m) { m.primitive()["attributes"]["POSITION"] = 77; },
     {"/meshes/0/primitives/0/attributes/POSITION: names accessor 77"}},
    {"NoSuchMaterial",
     [](SmallGltf& m) { m.primitive()["material"] = 4; },
     {"/meshes/0/primitives/0/material: 4, but there are 1"}},
    {"NoSuchMode",
     [](SmallGltf& m) { m.primitive()["mode"] = 9; },
     {"/meshes/0/primitives/0/mode: 9"}},
    {"NoSuchMesh",
     [](SmallGltf& m) { m.json["nodes"][0]["mesh"] = 2; },
     {"/nodes/0/mesh: names mesh 2, but there are 1"}},

    {"NodeCycle",
     [](SmallGltf& m) {
         m.json["nodes"][0]["children"] = {1};
         m.json["nodes"].push_back({{"children", {0}}});
     },
     {"/nodes/0: is its own ancestor"}},
    {"NodeWithTwoParents",
     [](SmallGltf& m) {
         m.json["nodes"][0]["children"] = {1, 1};
         m.json["nodes"].push_back({{"name", "twice"}});
     },
     {"/nodes/1: has two parents"}},
    {"NodesTooDeep",
     [](SmallGltf& m) {
         for (int i = 0; i < 256; ++i) {
             m.json["nodes"][static_cast<std::size_t>(i)]["children"] = {i + 1};
             m.json["nodes"].push_back(nlohmann::json::object());
         }
     },
     {"/nodes/256: lies deeper than 256"}},
    {"NoSuchChild",
     [](SmallGltf& m) { m.json["nodes"][0]["children"] = {5}; },
     {"/nodes/0/children: names node 5, but there are 1"}},
    {"NoSuchScene", [](SmallGltf& m) { m.json["scene"] = 3; }, {"/scene: 3, but there are 1"}},
    {"MatrixOf15",
     [](SmallGltf& m) { m.json["nodes"][0]["matrix"] = std::vector<float>(15, 1.0f); },
     {"/nodes/0/matrix: 15 numbers; expected 16"}},
    {"RotationOfLengthZero",
     [](SmallGltf& m) {
         m.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     {"/nodes/0/rotation"}},
    {"TransformOverflows",
     [](SmallGltf& m) {
         m.json["nodes"][0]["scale"] = {1e300, 1, 1};
     },
     {"/nodes/0: its transform is not finite"}},
    {"NoSuchLight",
     [](SmallGltf& m) { m.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; },
     {"/nodes/0/extensions/KHR_lights_punctual/light: 0, but there are 0"}},
    {"CameraOfNoAngle",
     [](SmallGltf& m) {
         m.json["nodes"][0]["camera"] = 0;
         m.json["cameras"] = {
             {{"type", "perspective"}, {"perspective", {{"yfov", 0.0}, {"znear", 0.1}}}}};
     },
     {"/cameras/0", "fov_y"}},
};

INSTANTIATE_TEST_SUITE_P(Square, MalformedGltf, testing::ValuesIn(kCases),
                         [](const auto& param) { return param.param.name; });

TEST(MalformedFiles, TruncatedJsonIsRefusedWithLineAndColumn) {
    const ScratchFolder folder;
    const std::string path = folder.write("cut.gltf", "{\n  \"asset\": {\"version\": ");
    const std::string error = loadError(path);
    EXPECT_NE(error.find(path), std::string::npos);
    EXPECT_NE(error.find("line 2"), std::string::npos) << error;
}

TEST(MalformedFiles, TruncationsOfAGlbAreRefused) {
    const ScratchFolder folder;
    const std::string whole = SmallGltf().glb();
    EXPECT_EQ(loadScene(folder.write("whole.glb", whole)).triangles.size(), 2u);
    for (std::size_t size = 0; size < whole.size(); size += 5) {
        const std::string path = folder.write("cut.glb", whole.substr(0, size));
        EXPECT_THROW((void)loadScene(path), SceneError) << size << " bytes";
    }
}

TEST(MalformedFiles, TruncationsOfAGlbWithACorrectedLengthAreRefused) {
    const ScratchFolder folder;
    const std::string whole = SmallGltf().glb();
    for (std::size_t size = 12; size < whole.size(); size += 5) {
        std::string cut = whole.substr(0, size);
        cut.replace(8, 4, SmallGltf::word(static_cast<std::uint32_t>(size)));
        EXPECT_THROW((void)loadScene(folder.write("cut.glb", cut)), SceneError) << size << " bytes";
    }
}

TEST(MalformedFiles, BadMagicAndVersionOfAGlbAreNamed) {
    const ScratchFolder folder;
    std::string magic = SmallGltf().glb();
    magic[0] = 'G';
    EXPECT_NE(loadError(folder.write("magic.glb", magic)).find("does not begin with \"glTF\""),
              std::string::npos);
    std::string version = SmallGltf().glb();
    version[4] = 1;
    EXPECT_NE(loadError(folder.write("version.glb", version)).find("GLB version 1"),
              std::string::npos);
}

TEST(MalformedFiles, GlbChunkLongerThanTheFileIsNamedWithItsByte) {
    const ScratchFolder folder;
    std::string glb = SmallGltf().glb();
    glb.replace(12, 4, SmallGltf::word(0xffffffffu));
    const std::string error = loadError(folder.write("chunk.glb", glb));
    EXPECT_NE(error.find("byte 12: a chunk of 4294967295 bytes"), std::string::npos) << error;
}

TEST(MalformedFiles, ChangedBytesLoadOrAreRefused) {
    const ScratchFolder folder;
    const std::string whole = SmallGltf().glb();
    for (std::size_t i = 12; i < whole.size(); i += 11)
        for (const char value : {'\0', '9', '\xff'}) {
            std::string changed = whole;
            changed[i] = value;
            try {
                (void)loadScene(folder.write("changed.glb", changed));
            } catch (const SceneError&) {
            }
        }
}

TEST(MalformedFiles, LinkOutOfTheFolderIsRefused) {
    const ScratchFolder outside;
    const ScratchFolder folder;
    SmallGltf model;
    outside.write("secret.bin", model.binary);
    std::filesystem::create_symlink(outside.path() / "secret.bin", folder.path() / "link.bin");
    model.json["buffers"][0]["uri"] = "link.bin";
    const std::string error = loadError(model.write(folder));
    EXPECT_NE(error.find("\"link.bin\": leads outside the model's folder"), std::string::npos)
        << error;
}

TEST(MalformedFiles, NeighbourFolderWithTheSamePrefixIsOutside) {
    const ScratchFolder folder;
    SmallGltf model;
    folder.write("model-secret/square.bin", model.binary);
    model.json["buffers"][0]["uri"] = "../model-secret/square.bin";
    const std::string error = loadError(folder.write("model/square.gltf", model.json.dump()));
    EXPECT_NE(error.find("outside"), std::string::npos) << error;
}

TEST(MalformedFiles, ControlBytesOfAUriDoNotReachTheTerminal) {
    const ScratchFolder folder;
    SmallGltf model;
    model.json["buffers"][0]["uri"] = "a\x1b[31m.bin";
    const std::string error = loadError(model.write(folder));
    EXPECT_EQ(error.find('\x1b'), std::string::npos);
    EXPECT_NE(error.find("a?[31m.bin"), std::string::npos) << error;
}

TEST(MalformedFiles, MissingModelAndUnknownKindAreNamed) {
    EXPECT_NE(loadError("nowhere/at_all.gltf").find("nowhere/at_all.gltf: cannot be read"),
              std::string::npos);
    EXPECT_NE(loadError("model.obj").find("model.obj: not the name of a scene"), std::string::npos);
}

} // namespace
} // namespace hone

// SPDX-License-Identifier: Apache-2.0
#include "hone/passes/glsl/inspect_spirv.h"

#include "hone/core/error.h"

#include <spirv_cross/spirv.hpp>

#include <algorithm>
#include <unordered_map>

namespace hone {
namespace {

/// What one invocation may keep in variables: drivers put more on a stack that is not made for it.
constexpr std::uint64_t kMaxVariableBytes = 16384;

constexpr const char* kForItself = "every pixel is computed for itself";

using Words = std::span<const std::uint32_t>;

/// A text within an instruction, four bytes a word, the first in the lowest bits.
std::string text(Words words) {
    std::string result;
    for (const std::uint32_t word : words)
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const char c = static_cast<char>(word >> shift & 0xffu);
            if (c == '\0')
                return result;
            result += c;
        }
    return result;
}

class Inspector {
public:
    explicit Inspector(ShaderFacts& facts) : facts_(facts) {}

    /// `code` is one instruction; code[0] its head.
    void read(spv::Op op, Words code) {
        const auto at = [&](std::size_t i) { return i < code.size() ? code[i] : 0; };
        switch (op) {
        case spv::OpCapability:
            if (at(1) != spv::CapabilityShader)
                refuse(neededBy(at(1)));
            break;
        case spv::OpEntryPoint:
            entry_ = at(2);
            break;
        case spv::OpName:
            names_[at(1)] = text(code.subspan(2));
            break;
        case spv::OpMemberName:
            member(at(1), at(2)).name = text(code.subspan(3));
            break;
        case spv::OpMemberDecorate:
            if (at(3) == spv::DecorationOffset)
                member(at(1), at(2)).offset = at(4);
            break;
        case spv::OpTypeBool:
            bytes_[at(1)] = 4;
            break;
        case spv::OpTypeInt:
        case spv::OpTypeFloat:
            bytes_[at(1)] = at(2) / 8;
            break;
        case spv::OpTypeVector:
        case spv::OpTypeMatrix:
            bytes_[at(1)] = bytes_[at(2)] * at(3);
            break;
        case spv::OpTypeArray:
            bytes_[at(1)] =
                bytes_[at(2)] > kMaxVariableBytes ? bytes_[at(2)] : bytes_[at(2)] * numbers_[at(3)];
            break;
        case spv::OpTypeStruct:
            for (const std::uint32_t type : code.subspan(std::min<std::size_t>(2, code.size())))
                bytes_[at(1)] = std::min(bytes_[at(1)] + bytes_[type], ~std::uint64_t{0} >> 1);
            break;
        case spv::OpTypePointer:
            pointees_[at(1)] = at(3);
            break;
        case spv::OpConstant:
            numbers_[at(2)] = at(3);
            break;
        case spv::OpSpecConstant:
        case spv::OpSpecConstantTrue:
        case spv::OpSpecConstantFalse:
            refuse({"a constant that is chosen later", "constant_id",
                    "declare a parameter: #pragma hone param uint NAME = DEFAULT"});
            break;
        case spv::OpVariable:
            readVariable(at(1), at(2), static_cast<spv::StorageClass>(at(3)));
            break;
        case spv::OpFunction:
            function_ = at(2);
            break;
        case spv::OpControlBarrier:
        case spv::OpMemoryBarrier:
            refuse({"a barrier", "barrier", kForItself});
            break;
        case spv::OpLoad:
        case spv::OpArrayLength:
            use(at(3));
            break;
        case spv::OpAccessChain:
        case spv::OpInBoundsAccessChain:
            use(at(3), at(4));
            break;
        case spv::OpStore:
            use(at(1));
            break;
        case spv::OpCopyMemory:
            use(at(1));
            use(at(2));
            break;
        case spv::OpFunctionCall:
            for (std::size_t i = 4; i < code.size(); ++i)
                use(code[i]);
            break;
        default:
            break;
        }
    }

    void finish() {
        if (variable_bytes_ > kMaxVariableBytes)
            refuse({"variables of more than " + std::to_string(kMaxVariableBytes / 1024) +
                        " KiB for one pixel",
                    "", "make arrays smaller"});
        facts_.constants = std::move(members_[constants_type_]);
    }

private:
    void refuse(ShaderFacts::Refused refused) {
        if (std::ranges::find(facts_.refused, refused.what, &ShaderFacts::Refused::what) ==
            facts_.refused.end())
            facts_.refused.push_back(std::move(refused));
    }

    static ShaderFacts::Refused neededBy(std::uint32_t capability) {
        constexpr const char* kHint = "a shader runs on every device, so it has what all have";
        if (capability == spv::CapabilityFloat64)
            return {"numbers of type double", "double", kHint};
        return {"what needs the capability " + std::to_string(capability) + " of SPIR-V", "",
                kHint};
    }

    ShaderFacts::Member& member(std::uint32_t type, std::uint32_t index) {
        std::vector<ShaderFacts::Member>& members = members_[type];
        HONE_ASSERT(index < 4096, "a struct of more than 4096 members");
        if (index >= members.size())
            members.resize(index + 1);
        return members[index];
    }

    void readVariable(std::uint32_t pointer, std::uint32_t id, spv::StorageClass where) {
        const std::uint32_t type = pointees_[pointer];
        const std::string& name = names_[id].empty() ? names_[type] : names_[id];
        switch (where) {
        case spv::StorageClassFunction:
            variable_bytes_ = std::min(variable_bytes_ + bytes_[type], ~std::uint64_t{0} >> 1);
            return;
        case spv::StorageClassPrivate:
            variable_bytes_ = std::min(variable_bytes_ + bytes_[type], ~std::uint64_t{0} >> 1);
            break;
        case spv::StorageClassStorageBuffer:
            facts_.buffers.push_back(names_[type]);
            break;
        case spv::StorageClassPushConstant:
            constants_ = id;
            constants_type_ = type;
            return;
        case spv::StorageClassInput:
            return;
        case spv::StorageClassWorkgroup:
            return refuse({"a shared variable", "shared", kForItself});
        default:
            return refuse({"a uniform, an image or a sampler: \"" + name + "\"", name,
                           "what comes from the graph is declared: #pragma hone in TYPE NAME"});
        }
        globals_[id] = name;
    }

    /// An instruction names the global variable `id`, or an element or member of it.
    void use(std::uint32_t id, std::uint32_t index = 0) {
        if (function_ == entry_)
            return;
        if (id == constants_ && id != 0) {
            const std::vector<ShaderFacts::Member>& members = members_[constants_type_];
            if (numbers_[index] < members.size())
                facts_.used.push_back(members[numbers_[index]].name);
        } else if (const auto global = globals_.find(id); global != globals_.end()) {
            facts_.used.push_back(global->second);
        }
    }

    ShaderFacts& facts_;
    std::unordered_map<std::uint32_t, std::string> names_;
    std::unordered_map<std::uint32_t, std::string> globals_;
    std::unordered_map<std::uint32_t, std::vector<ShaderFacts::Member>> members_; ///< by struct
    std::unordered_map<std::uint32_t, std::uint64_t> bytes_;                      ///< by type
    std::unordered_map<std::uint32_t, std::uint64_t> numbers_;                    ///< of constants
    std::unordered_map<std::uint32_t, std::uint32_t> pointees_;
    std::uint64_t variable_bytes_ = 0;
    std::uint32_t entry_ = 0;
    std::uint32_t function_ = 0; ///< that is read
    std::uint32_t constants_ = 0;
    std::uint32_t constants_type_ = 0;
};

} // namespace

bool ShaderFacts::uses(std::string_view name) const {
    return std::ranges::find(used, name) != used.end();
}

std::uint32_t ShaderFacts::offsetOf(std::string_view constant) const {
    const auto found = std::ranges::find(constants, constant, &Member::name);
    HONE_ASSERT(found != constants.end(), "no push constant " + std::string(constant));
    return found->offset;
}

ShaderFacts inspectSpirv(Words spirv) {
    constexpr std::size_t kHeaderWords = 5;
    ShaderFacts facts;
    Inspector inspector(facts);
    HONE_ASSERT(spirv.size() >= kHeaderWords && spirv[0] == spv::MagicNumber, "no SPIR-V");
    for (Words rest = spirv.subspan(kHeaderWords); !rest.empty();) {
        const std::size_t words = rest[0] >> spv::WordCountShift;
        HONE_ASSERT(words > 0 && words <= rest.size(), "a cut instruction");
        inspector.read(static_cast<spv::Op>(rest[0] & spv::OpCodeMask), rest.first(words));
        rest = rest.subspan(words);
    }
    inspector.finish();
    return facts;
}

} // namespace hone

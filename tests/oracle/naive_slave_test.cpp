// SPDX-License-Identifier: Apache-2.0
// The oracle is held against the reference's own check list (section 8) before it judges anybody.
//
// A check is a line of words:  >hex telegram in, <hex answer expected (<- none), rAA=VV processor read, pAA=VV peek,
// wAA=VV write, +N milliseconds, irr=XXXX (User_Timer_Clock left out), ack (IRR cleared), diag=hex Slave_Diag data,
// dp=N DP_State.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>

#include "naive_slave.hpp"

namespace {

using namespace oracle;

Octets from_hex(const std::string& text) {
    Octets out;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2)
        out.push_back(octet(static_cast<unsigned>(std::stoul(text.substr(i, 2), nullptr, 16))));
    return out;
}
std::string to_hex(const Octets& octets) {
    static constexpr char kDigits[] = "0123456789ABCDEF";
    std::string out;
    for (const Octet o : octets) {
        out += kDigits[o >> 4];
        out += kDigits[o & 15];
    }
    return out;
}

class Bench {
public:
    explicit Bench(const Kind& kind) : slave{kind} {}

    std::string send(const Octets& telegram) {
        const Time bit = kBitClk[3] * kClk, start = slave.now + 100 * bit,
                   end = start + 11 * bit * static_cast<Time>(telegram.size());
        slave.sent.clear();
        slave.advance(start - 1);
        slave.carrier(start);
        slave.advance(end);
        slave.hear(start, bit, telegram);
        slave.advance(end + kMs / 5 + 260 * 11 * bit);
        return slave.sent.empty() ? "-" : to_hex(slave.sent.back().octets);
    }

    void p0(const std::string& changes) {
        static constexpr std::pair<unsigned, unsigned> kCells[]{
            {0x06, 0xC0},  {0x07, 0x01},  {0x16, 8},    {0x17, 0x20}, {0x18, 0xFF}, {0x19, 0xFF}, {0x1A, 2},
            {0x1B, 0x10},  {0x1C, 0x11},  {0x1D, 0x12}, {0x1E, 2},    {0x1F, 0x13}, {0x20, 0x14}, {0x21, 0x15},
            {0x24, 6},     {0x25, 6},     {0x26, 0x16}, {0x27, 0x18}, {0x28, 20},   {0x29, 20},   {0x2B, 0x1A},
            {0x2C, 0x1D},  {0x30, 0x21},  {0x32, 0x24}, {0x33, 2},    {0x34, 0x27}, {0x3A, 0x11}, {0x3B, 0x47},
            {0x138, 0x11}, {0x139, 0x21}, {0x3D, 30}};
        for (const auto& [address, value] : kCells) slave.write(address, value);
        run(changes);
        slave.write(8, 1);
        slave.advance(slave.now + 320 * kMs);
        send(from_hex("100802495316"));
        slave.irr = 0;
    }
    void p1() {
        send(from_hex("680C0C688882"
                      "5D3D3E8802050B471100D416"));
    }
    void p2() {
        p1();
        send(from_hex("6807076888827D3E3E11213516"));
        slave.read(0x10);
        const unsigned u = (slave.peek(8) >> 4) & 3;
        slave.write(slave.cell(0x1F + u - 1) * 8, 0xAB);
        slave.write(slave.cell(0x1F + u - 1) * 8 + 1, 0xCD);
        slave.read(0x09);
        slave.irr = 0;
    }
    void run(const std::string& script) {
        std::istringstream in{script};
        for (std::string word; in >> word;) step(word);
    }

    NaiveSlave slave;

private:
    static unsigned hex(const std::string& text) { return static_cast<unsigned>(std::stoul(text, nullptr, 16)); }
    void step(const std::string& word) {
        const std::size_t eq = word.find('=');
        const std::string value = eq == std::string::npos ? "" : word.substr(eq + 1);
        SCOPED_TRACE(word);
        if (word[0] == '>') last_ = send(from_hex(word.substr(1)));
        else if (word[0] == '<') EXPECT_EQ(last_, word.substr(1));
        else if (word[0] == '+') slave.advance(slave.now + std::stol(word.substr(1)) * kMs);
        else if (word == "ack") slave.irr = 0;
        else if (word.starts_with("irr=")) EXPECT_EQ(slave.irr & ~0x10u, hex(value));
        else if (word.starts_with("dp=")) EXPECT_EQ(static_cast<unsigned>(slave.dp), hex(value));
        else if (word.starts_with("diag=")) EXPECT_EQ(diagnosis(), value);
        else if (word[0] == 'r') EXPECT_EQ(slave.read(hex(word.substr(1, eq - 1))), hex(value));
        else if (word[0] == 'p') EXPECT_EQ(slave.peek(hex(word.substr(1, eq - 1))), hex(value));
        else if (word[0] == 'w') slave.write(hex(word.substr(1, eq - 1)), hex(value));
        else FAIL() << "what is " << word;
    }
    std::string diagnosis() {  // first cycle (FCB 1, FCV 0): never a retry
        const std::string whole = send(from_hex("6805056888826D3C3EF116"));
        return whole.size() < 22 ? whole : whole.substr(18, whole.size() - 22);
    }
    std::string last_;
};

struct Check {
    const char* id;
    int precondition;     ///< P0, P1, P2
    const char* changes;  ///< before Start
    const char* script;
};

// clang-format off
constexpr Check kChecks[]{
    {"C001", 0, "", ">100802495316 <100208000A16"},
    {"C002", 0, "", ">100802495216 <- >100802495316 <100208000A16 irr=0"},
    {"C003", 0, "", ">6805046888826D3C3EF116 <-"},
    {"C004", 0, "", ">6805056888826D3C3EF117 <-"},
    {"C010", 0, "", ">DC0502 <- >100802495316 <100208000A16"},
    {"C011", 0, "", ">1008024E5816 <100208030D16"},
    {"C012", 0, "", ">107F0249CA16 <- >68050568FF826D3C3E6816 <-"},
    {"C013", 0, "", ">680C0C688882553D3E8001010B471100BF16 <100208030D16 irr=0"},
    {"C015", 0, "", ">6806066888827D343E01FA16 <100208030D16"},
    {"C017", 2, "", ">6805056808025D1234AD16 <68050568020808ABCD8A16 irr=2000 ack >6805056808025D1234AD16 <68050568020808ABCD8A16 irr=0"},
    {"C018", 2, "", ">6805056808025D1234AD16 ack >6805056888836D3C3EF216 >6805056808025D1234AD16 irr=2000"},
    {"C024", 2, "", "+110 irr=200A dp=0 diag=020500FF4711"},
    {"C028", 0, "", ">6805056888826D3C3EF116 <680B0B688288083E3C020500FF4711EA16"},
    {"C029", 0, "", ">680C0C6888825D3D3E8802050B471100D416 <E5 irr=0 dp=1 p04=91 diag=020C00024711"},
    {"C030", 0, "", ">680C0C6888825D3D3E8001010B471100C716 <E5 diag=020400024711 p04=51"},
    {"C031", 0, "", ">680F0F6888825D3D3E8802050B4711018000005516 <E5 irr=800 p2F=0A p30=1A p2B=21 w03=08 irr=800 r0E=00 irr=0"},
    {"C032", 0, "", ">680C0C6888825D3D3E8802050B471200D516 <E5 dp=0 irr=0 diag=420500FF4711"},
    {"C033", 0, "", ">680B0B6888825D3D3E8802050B4711D416 <E5 diag=420500FF4711"},
    {"C034", 0, "", ">680C0C6888825D3D3E8800050B471100D216 <E5 diag=420500FF4711"},
    {"C035", 0, "w06=80", ">680C0C6888825D3D3EB802050B4711010516 <E5 diag=520500FF4711"},
    {"C036", 0, "", ">680C0C6888825D3D3EB802050B4711010516 <E5 diag=020C00024711"},
    {"C037", 0, "", ">680F0F6888825D3D3E8802050B4711008002005616 <E5 diag=420500FF4711"},
    {"C038", 0, "w07=21", ">680F0F6888825D3D3E8802050B4711008000005416 <E5 diag=420500FF4711"},
    {"C039", 0, "w07=21", ">680F0F6888825D3D3E8802050B471100C000009416 <E5 irr=800"},
    {"C040", 0, "", ">680F0F6888825D3D3E8802050B471100C00010A416 <E5 diag=420500FF4711"},
    {"C042", 0, "", ">681A1A6888825D3D3E8802050B4711000000000000000000000000000000D416 <100208020C16 dp=0 irr=0 diag=020500FF4711"},
    {"C043", 0, "", ">680F0F6888825D3D3E8802050B4711018000005516 <E5 >680F0F6888827D3D3E8802050B4711018000007516 <E5 r0E=01 irr=800 p30=21 r0E=00 irr=0"},
    {"C044", 0, "", "r0E=03"},
    {"C045", 0, "", ">680F0F6888825D3D3E8802050B4711018000005516 <E5 r0F=00 dp=0 diag=420500FF4711"},
    {"C046", 1, "", ">680C0C6888827D3D3E400101004711009C16 <E5 dp=0 irr=2000 diag=020500FF4711"},
    {"C048", 2, "", ">680C0C6888825D3D3E8802050B471100D416 <E5 dp=2 irr=0"},
    {"C049", 2, "", ">680C0C6888836D3D3E8802050B471100E516 <E5 dp=2 irr=0 diag=000C00024711"},
    {"C051", 2, "", ">680C0C6888825D3D3E8802050B471200D516 <E5 dp=0 irr=2002 diag=420500FF4711"},
    {"C052", 0, "", ">6807076888827D3E3E11213516 <E5 irr=0 dp=0"},
    {"C053", 1, "", ">6807076888827D3E3E11213516 <E5 irr=400 p31=02 r10=00 dp=2 irr=2 p04=A1"},
    {"C054", 1, "", ">6807076888827D3E3E11213516 <E5 r11=00 dp=0 diag=060500FF4711"},
    {"C057", 1, "", "w08=10 >6807076888827D3E3E11213516 r10=00 >6805056888825D3B3EE016 <680707688288083E3B1121BD16 dp=2"},
    {"C058", 1, "", ">A288827D3E3E1010202011219516 <E5 p31=06 pD0=10 pD5=21"},
    {"C063", 0, "", ">680A0A6888827D353E05810000AA2A16 <100208030D16"},
    {"C062", 1, "w07=09", ">680A0A6888827D353E05810000AA2A16 <E5 irr=40 r0E=00 irr=0"},
    {"C064", 0, "", ">6809096888825D373E094711003D16 <100208030D16"},
    {"C065", 0, "w2E=2A", ">6809096888825D373E094711003D16 <E5 irr=200 p2D=04 p16=09 >100902495416 <100209000B16 >100802495316 <-"},
    {"C066", 0, "w2E=2A", ">6809096888825D373E094712003E16 <E5 irr=0 p16=08"},
    {"C071", 0, "", ">6805056808027D1234CD16 <100208030D16"},
    {"C072", 2, "", ">6805056808025D1234AD16 <68050568020808ABCD8A16 irr=2000 r0B=07"},
    {"C073", 2, "", ">6805056808037D1234CE16 <100308030E16 irr=0"},
    {"C075", 2, "", "r0D=02 >6805056808025D1234AD16 <6805056802080AABCD8C16 >6805056888827D3C3E0116 >6805056808025D1234AD16 <68050568020808ABCD8A16"},
    {"C081", 2, "", ">6804046808025D016816 <68050568020808ABCD8A16 dp=0 diag=060500FF4711"},
    {"C082", 2, "", ">6806066808025D0102036D16 <100208020C16 dp=0 diag=060500FF4711"},
    {"C083", 2, "", ">1008025D6716 <68050568020808ABCD8A16 dp=0 diag=060500FF4711"},
    {"C084", 2, "w07=21", ">1008025D6716 <68050568020808ABCD8A16 dp=2 r0B=0F"},
    {"C085", 2, "w18=02 w19=00", ">6805056808025D1234AD16 dp=2 >6805056808027D1234CD16 <68050568020808ABCD8A16 dp=0 >6805056808025D1234AD16 <100208030D16"},
    {"C087", 2, "", ">68070768FF82463A3E02004116 <- p3C=02 irr=2100 r0B=0F"},
    {"C089", 2, "", ">68070768FF83463A3E02004216 <- irr=0"},
    {"C091", 2, "", ">68070768FF82463A3E01004016 <- irr=0 p3C=00"},
    {"C093", 2, "", ">6807076888825D3A3E0200E116 <100208030D16"},
    {"C094", 2, "", ">68070768FF82463A3E20005F16 ack >6805056808025D1234AD16 >6805056808027D56785516 irr=0 >68070768FF82463A3E20005F16 irr=2100 diag=002C00024711"},
    {"C104", 1, "", ">6805056888827D383EFD16 <100208030D16"},
    {"C106", 0, "", "p0A=27 r0B=0D p0A=93"},
    {"C112", 0, "", "p08=E1 r09=03 p08=39 r09=02 p08=2D r09=03 p08=39"},
};
// clang-format on

class NaiveSlaveChecks : public testing::TestWithParam<Check> {};

TEST_P(NaiveSlaveChecks, agree_with_section_8) {
    Bench bench{kKind[2]};
    bench.p0(GetParam().changes);
    if (GetParam().precondition == 1) bench.p1();
    if (GetParam().precondition == 2) bench.p2();
    bench.run(GetParam().script);
}

INSTANTIATE_TEST_SUITE_P(reference, NaiveSlaveChecks, testing::ValuesIn(kChecks),
                         [](const testing::TestParamInfo<Check>& p) { return std::string{p.param.id}; });

}  // namespace

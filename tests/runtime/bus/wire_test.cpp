// SPDX-License-Identifier: MIT
#include "runtime/bus/wire.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <random>

#include "tests/support/allocation_counter.hpp"

namespace mixloop {
namespace {

constexpr int kN = 3;
constexpr std::size_t kOffsetOfN = 8;  // behind the fingerprint

std::vector<std::uint8_t> copy(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

Outbox<state_t> some_state(int n = kN) {
  Outbox<state_t> outbox(n);
  set_header(outbox.message, {.n = n, .utime = 1000, .seq = 1, .session = 42, .config = -7});
  for (int i = 0; i < n; ++i) {
    outbox.message.psi_measured[i] = 0.1 * i;
    outbox.message.psid_measured[i] = -i;
  }
  outbox.message.flags = state_t::FLAG_HOLD;
  return outbox;
}

TEST(Wire, BringsBackWhatWasSent) {
  Outbox<state_t> sent = some_state();
  Inbox<state_t> inbox(kN);
  ASSERT_EQ(inbox.read(sent.encode()), std::nullopt);
  const state_t& got = inbox.message;
  EXPECT_EQ(got.utime, 1000);
  EXPECT_EQ(got.seq, 1);
  EXPECT_EQ(got.session, 42);
  EXPECT_EQ(got.config, -7);
  EXPECT_EQ(got.psi_measured, sent.message.psi_measured);
  EXPECT_EQ(got.psid_measured, sent.message.psid_measured);
  EXPECT_EQ(got.flags, state_t::FLAG_HOLD);
}

template <class Message>
class EveryMessage : public testing::Test {};
template <class>
struct TypesOf;
template <class... Messages>
struct TypesOf<std::variant<std::monostate, Messages...>> {
  using Types = testing::Types<Messages...>;
};
TYPED_TEST_SUITE(EveryMessage, TypesOf<AnyMessage>::Types);

TYPED_TEST(EveryMessage, BeginsWithTheHeaderAndIsReadAgain) {
  Outbox<TypeParam> outbox(kN);
  set_header(outbox.message, {.n = kN, .utime = 11, .seq = 12, .session = -13, .config = 14});
  const auto header = peek(outbox.encode());
  ASSERT_TRUE(header);
  EXPECT_EQ(header->n, kN);
  EXPECT_EQ(header->utime, 11);
  EXPECT_EQ(header->seq, 12);
  EXPECT_EQ(header->session, -13);
  EXPECT_EQ(header->config, 14);
  Inbox<TypeParam> inbox(kN);
  EXPECT_EQ(inbox.read(outbox.encoded()), std::nullopt);
}

TYPED_TEST(EveryMessage, IsRejectedAtEveryOtherLength) {
  Outbox<TypeParam> outbox(kN);
  auto bytes = copy(outbox.encode());
  Inbox<TypeParam> inbox(kN);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_EQ(inbox.read({bytes.data(), length}), Reject::length) << length;
  bytes.push_back(0);
  EXPECT_EQ(inbox.read(bytes), Reject::length);
  bytes.resize(60000);
  EXPECT_EQ(inbox.read(bytes), Reject::length);
}

TYPED_TEST(EveryMessage, IsRejectedWithAnotherNAndAllocatesNothingForIt) {
  Inbox<TypeParam> inbox(kN);
  Outbox<TypeParam> outbox(kN);
  auto bytes = copy(outbox.encode());
  for (const std::int32_t n :
       {0, 1, 4, -1, std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()}) {
    for (int i = 0; i < 4; ++i)
      bytes[kOffsetOfN + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(n) >> (24 - 8 * i));
    const AllocationCounter allocations;
    EXPECT_EQ(inbox.read(bytes), Reject::dimension) << n;
    EXPECT_EQ(allocations.count(), 0U);
  }
}

TYPED_TEST(EveryMessage, IsRejectedWithAnotherFingerprint) {
  Outbox<TypeParam> outbox(kN);
  auto bytes = copy(outbox.encode());
  bytes[3] ^= 1;
  EXPECT_EQ(Inbox<TypeParam>(kN).read(bytes), Reject::fingerprint);
}

TYPED_TEST(EveryMessage, SurvivesRandomBytes) {
  std::mt19937_64 random(3);
  Outbox<TypeParam> outbox(kN);
  const auto sound = copy(outbox.encode());
  Inbox<TypeParam> inbox(kN);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> bytes = sound;
    if (random() % 2 == 0) bytes.resize(random() % 400);
    for (std::uint64_t flips = random() % 8; flips > 0 && !bytes.empty(); --flips)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    if (inbox.read(bytes) == std::nullopt) {
      EXPECT_TRUE(is_finite(inbox.message));
      EXPECT_EQ(inbox.message.n, kN);
    }
  }
}

TEST(Wire, RejectsEveryPlaceOfANumberThatIsNotFinite) {
  Inbox<state_t> inbox(kN);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (int i = 0; i < 2 * kN; ++i) {
      Outbox<state_t> outbox = some_state();
      (i < kN ? outbox.message.psi_measured[i] : outbox.message.psid_measured[i - kN]) = bad;
      EXPECT_EQ(inbox.read(outbox.encode()), Reject::not_finite);
    }
    Outbox<reference_t> reference(kN);
    reference.message.acceleration_desired[2] = bad;
    EXPECT_EQ(Inbox<reference_t>(kN).read(reference.encode()), Reject::not_finite);
    Outbox<truth_t> truth(kN);
    truth.message.work = bad;
    EXPECT_EQ(Inbox<truth_t>(kN).read(truth.encode()), Reject::not_finite);
  }
  Outbox<state_t> huge = some_state();
  huge.message.psi_measured[0] = huge.message.psi_measured[1] = std::numeric_limits<double>::max();
  EXPECT_EQ(inbox.read(huge.encode()), std::nullopt) << "finite, if large";
}

TEST(Wire, AllocatesNothingAfterConstruction) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has malloc";
  Outbox<reference_t> outbox(kN);
  Inbox<reference_t> inbox(kN);
  ASSERT_EQ(inbox.read(outbox.encode()), std::nullopt);
  const AllocationCounter allocations;
  for (int i = 0; i < 100; ++i) {
    outbox.message.seq = i;
    ASSERT_EQ(inbox.read(outbox.encode()), std::nullopt);
  }
  EXPECT_EQ(allocations.count(), 0U);
}

TEST(AllocationCounter, SeesEveryKindOfAllocation) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer has malloc";
  const AllocationCounter allocations;
  std::vector<double> vector(10);
  const std::string text(100, 'x');
  std::free(std::realloc(std::malloc(8), 16));
  EXPECT_EQ(allocations.count(), 4U);
  EXPECT_NE(allocations.first_caller(), nullptr);
}

TEST(Rejects, AreCountedByCause) {
  Rejects rejects;
  for (std::size_t i = 0; i < kRejects.size(); ++i) {
    EXPECT_EQ(kRejects[i].cause, static_cast<Reject>(i));
    EXPECT_FALSE(kRejects[i].name.empty());
    rejects.count(kRejects[i].cause);
    EXPECT_EQ(rejects.total(), i + 1);
    EXPECT_EQ(rejects.of(kRejects[i].cause), 1U);
  }
  EXPECT_EQ(kRejects.back().cause, Reject::sender);
}

// Old logs and strangers' programs go by them; a package's name is no part of them.
TEST(Wire, FingerprintsAreThoseOfTheFirstVersion) {
  const auto of = [](std::int64_t hash) { return static_cast<std::uint64_t>(hash); };
  EXPECT_EQ(of(state_t::getHash()), 0x1652a39f305f214e);
  EXPECT_EQ(of(reference_t::getHash()), 0x9ce38080ae1734f1);
  EXPECT_EQ(of(command_t::getHash()), 0x8da514a34550a43a);
  EXPECT_EQ(of(truth_t::getHash()), 0xe4966e410d77703c);
  EXPECT_EQ(of(timing_t::getHash()), 0x3f90acd43032571b);
  EXPECT_EQ(of(sim_control_t::getHash()), 0x4ffb3376868eb89e);
  EXPECT_EQ(of(fault_t::getHash()), 0x44653a2b9631427f);
  EXPECT_EQ(of(stop_t::getHash()), 0xdaec020383f3dc4a);
}

}  // namespace
}  // namespace mixloop

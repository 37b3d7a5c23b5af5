// SPDX-License-Identifier: Apache-2.0
#include "model/io/seal.h"

#include <gtest/gtest.h>

#include "tests/model/io/scratch.h"

namespace tact::model::io::seal_test {

class SealTest : public Scratch {
 protected:
  SealTest() {
    auto file = SealedWriter::create(path("good"));
    EXPECT_TRUE(file);
    EXPECT_FALSE(file->put(std::string(300, 'a')));
    EXPECT_FALSE(file->put("the end"));
    EXPECT_FALSE(file->finish());
  }
  std::string trouble(const std::string& name) const {
    auto file = SealedFile::open(path(name), "");
    return file ? file->damage() : "not opened";
  }
};

TEST_F(SealTest, UndamagedFileHasAValidSeal) {
  auto file = SealedFile::open(path("good"), "");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->size_bytes(), 307u);
  std::string bytes(500, ' ');
  EXPECT_EQ(file->read(bytes.data(), 300), 300u);
  EXPECT_EQ(file->read(bytes.data(), 500), 7u);
  EXPECT_EQ(bytes.substr(0, 7), "the end");
  EXPECT_EQ(file->damage(), "");
  EXPECT_EQ(trouble("good"), "") << "read by no other";
}

TEST(Seal, IsTheSha256OfFips180) {
  Seal seal;
  EXPECT_EQ(seal.hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  seal.add("abc");
  EXPECT_EQ(seal.hex(), sha256_of("abc")) << "also of parts";
}

TEST_F(SealTest, IsBrokenByEveryBitAndEveryLength) {
  const std::string good = text("good");
  ASSERT_EQ(good.size(), 307 + kSealBytes);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bytes = good;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    put("bad", bytes);
    ASSERT_NE(trouble("bad"), "") << "bit " << bit;
  }
  for (std::size_t size = 0; size < good.size(); ++size) {
    put("bad", good.substr(0, size));
    ASSERT_NE(trouble("bad"), "") << "length " << size;
  }
  put("bad", good + "x");
  EXPECT_NE(trouble("bad"), "");
}

TEST(SealedText, IsBrokenByEveryBitAndEveryLength) {
  const std::string good = sealed_text("law = \"rhombus\"\n");
  EXPECT_TRUE(is_sealed(good));
  EXPECT_NE(good.find("\nsha256 = \""), std::string::npos);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bytes = good;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    EXPECT_FALSE(is_sealed(bytes)) << "bit " << bit;
  }
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(is_sealed(std::string_view(good).substr(0, size)));
  EXPECT_FALSE(is_sealed(good + "# more\n"));
}

}  // namespace tact::model::io::seal_test

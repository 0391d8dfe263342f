package skein.blocks

import java.nio.file.{Files, Path}
import scala.collection.immutable.ArraySeq
import skein.testing.TemporaryFolders

class LedgerSuite extends munit.FunSuite, TemporaryFolders:
  private val file = FunFixture[Path](
    _ => temporaryFolder().resolve(Ledger.Name),
    path =>
      Files.deleteIfExists(path)
      Files.delete(path.getParent)
  )
  private def bytes(text: String) = ArraySeq.from(text.getBytes("UTF-8"))
  private val question            = ArraySeq.from(Array.fill[Byte](32)(7))
  private def key(number: Int)    = BlockKey.of(bytes(s"work $number"))
  private def answer(number: Int) = bytes(s"answer $number" * number)

  private def open(path: Path) = Ledger.open(path, question).fold(fail(_), identity)

  private def written(path: Path, count: Int): Unit =
    val ledger = open(path)
    for number <- 0 until count do assert(ledger.accept(key(number), answer(number)))
    ledger.close()

  file.test("an answer is stored once, and is present after reopening the file"): path =>
    written(path, 3)
    val again = open(path)
    assertEquals(again.accept(key(1), bytes("another")), false)
    assertEquals((0 until 3).map(number => again.answer(key(number))), (0 until 3).map(n => Some(answer(n))))
    assertEquals(again.answer(key(3)), None)
    again.close()
    assertEquals(Ledger.audit(path), Ledger.Audit(3, 0, 0))

  file.test(
    "a ledger that is truncated anywhere keeps the complete records before the cut, and continues there"
  ): path =>
    written(path, 3)
    val whole = Files.readAllBytes(path)
    for length <- 0 until whole.length do
      Files.write(path, whole.take(length))
      val ledger = open(path)
      val there  = (0 until 3).takeWhile(number => ledger.answer(key(number)).contains(answer(number))).size
      assertEquals(ledger.size, there, s"cut at $length")
      assert(ledger.accept(key(2), answer(2)) || there == 3)
      ledger.close()
      assertEquals(Ledger.audit(path).broken, 0L)

  file.test("a truncated record is not complete, even if it lacks only zeros"): path =>
    val zeros  = ArraySeq.fill[Byte](20)(0)
    val ledger = open(path)
    assert(ledger.accept(key(0), answer(0)) && ledger.accept(key(1), zeros))
    ledger.close()
    val whole = Files.readAllBytes(path)
    for length <- whole.length - 20 to whole.length do
      Files.write(path, whole.take(length))
      val again = open(path)
      assertEquals(again.answer(key(1)), Option.when(length == whole.length)(zeros), s"cut at $length")
      assertEquals(again.broken, if length == whole.length then 0L else 24L + length - (whole.length - 20))
      again.close()

  file.test("a block is identified by all 128 bits of its key, the first of its work's SHA-256"): path =>
    assertEquals(BlockKey.of(ArraySeq.empty), BlockKey(0xe3b0c44298fc1c14L, 0x9afbf4c8996fb924L))
    val keys   = for high <- Seq(1L, 2L); low <- Seq(1L, 2L) yield BlockKey(high, low)
    val ledger = open(path)
    for (key, number) <- keys.zipWithIndex do assert(ledger.accept(key, answer(number)), key)
    ledger.close()
    val again = open(path)
    assertEquals(keys.map(again.answer), keys.indices.map(number => Some(answer(number))))
    again.close()

  file.test("an audit finds a record that occurs twice, and it counts once"): path =>
    written(path, 2)
    val bytes = Files.readAllBytes(path)
    Files.write(path, bytes ++ bytes.drop(48)): Unit
    assertEquals(Ledger.audit(path), Ledger.Audit(blocks = 2, repeats = 2, broken = 0))
    val ledger = open(path)
    assertEquals(ledger.size, 2)
    ledger.close()

  file.test("a damaged record is skipped, its block is computed again, and later records are kept"): path =>
    written(path, 3)
    val bytes  = Files.readAllBytes(path)
    val second = 48 + 24 + answer(0).length
    val record = 24 + answer(1).length
    for at <- second until second + record do
      val damaged = bytes.clone()
      damaged(at) = (damaged(at) ^ 0x10).toByte
      Files.write(path, damaged)
      val ledger = open(path)
      assertEquals(ledger.broken, record.toLong, s"byte $at")
      assertEquals(
        (0 until 3).map(number => ledger.answer(key(number))),
        Seq(Some(answer(0)), None, Some(answer(2)))
      )
      assert(ledger.accept(key(1), answer(1)))
      ledger.close()
      val again = open(path)
      assertEquals(
        (0 until 3).map(number => again.answer(key(number))),
        (0 until 3).map(number => Some(answer(number)))
      )
      again.close()
      assertEquals(Ledger.audit(path), Ledger.Audit(3, 0, record))
      assertEquals(Ledger.audit(path).broken, record.toLong)

  file.test("a damaged byte anywhere never changes an answer, and is reported"): path =>
    written(path, 3)
    val bytes = Files.readAllBytes(path)
    for at <- 48 until bytes.length do
      val damaged = bytes.clone()
      damaged(at) = (damaged(at) ^ 0x10).toByte
      Files.write(path, damaged)
      val ledger = open(path)
      for number <- 0 until 3; found <- ledger.answer(key(number)) do assertEquals(found, answer(number))
      assert(ledger.size < 3 && ledger.broken > 0, s"byte $at")
      ledger.close()

  file.test("a ledger without answers leaves no file"): path =>
    open(path).close()
    assert(!Files.exists(path))

  file.test(
    "another question's ledger, and a file that is not a ledger, are refused for that reason"
  ): path =>
    written(path, 1)
    val other = Ledger.open(path, ArraySeq.from(Array.fill[Byte](32)(8)))
    assert(other.left.exists(_.contains("another question")), other)
    Files.writeString(path, "x" * 100)
    assert(Ledger.open(path, question).left.exists(_.contains("expected a ledger")))

package skein.rpc

import org.apache.pekko.util.ByteString
import scala.util.Random
import upack.*

class FramerLaws extends munit.FunSuite:

  test("the framer returns the oracle's values for any segmentation of the stream"):
    for seed <- 1 to 100 do
      val random = Random(seed)
      val frames = Seq.fill(1 + random.nextInt(8))(Wire.pack(Wire.randomMsg(random)))
      val framer = Framer()
      val found  = Wire.framed(framer, Wire.segments(frames.flatten.toArray, random))
      assertEquals(texts(found), frames.map(hex), s"seed $seed")
      assert(!framer.midway, s"seed $seed")

  test("a value is complete with its last byte, even if the bytes arrive one at a time"):
    val frames =
      Seq(Arr(Int32(0), Binary(new Array[Byte](9000))), Obj(Str("x") -> Float64(1)), Null).map(Wire.pack)
    val framer = Framer()
    val found  = Wire.framed(framer, frames.flatten.map(ByteString(_)))
    assertEquals(texts(found), frames.map(hex))

  test("a truncated message is recognised"):
    val framer = Framer()
    framer.offer(ByteString(0x92, 0x01))
    assertEquals(framer.next(), Framed.NeedsMore)
    assert(framer.midway)

  test("no prefix of a message is mistaken for a value"):
    val frame = Wire.pack(Arr(Int32(300), Str("x" * 300), Arr(Float32(1), Ext(1, new Array[Byte](3))), Obj()))
    for cut <- 0 until frame.length do
      val framer = Framer()
      framer.offer(ByteString(frame.take(cut)))
      assertEquals(framer.next(), Framed.NeedsMore, s"cut at $cut")

  test("the byte 0xc1 is refused at any position, and nothing is read after it"):
    val framer = Framer()
    framer.offer(ByteString(0x01, 0x92, 0xc1, 0x01))
    assert(framer.next().isInstanceOf[Framed.Complete])
    val refusal = framer.next()
    assertEquals(refusal, Framed.Malformed("byte 0xc1, which MessagePack never uses"))
    assertEquals(framer.next(), refusal)

  test("a message is refused at its header when it cannot fit the frame limit"):
    val limits = FrameLimits(frameBytes = 1000)
    assertRefused(limits, "a message of at least 1006 bytes; at most 1000 are accepted")(
      0x92, 0xc6, 0x00, 0x00, 0x03, 0xe8
    )
    assertRefused(FrameLimits(), "a message of at least 4294967300 bytes; at most 67108864 are accepted")(
      0xc6, 0xff, 0xff, 0xff, 0xff
    )
    assertAccepted(FrameLimits(frameBytes = 5), Binary(new Array[Byte](3)))
    assertRefused(
      FrameLimits(frameBytes = 5),
      "a message of at least 6 bytes; at most 5 are accepted"
    )(0xc4, 0x04)

  test("a message that grows past the frame limit by small values is refused"):
    val limits = FrameLimits(frameBytes = 100)
    val bytes  = Seq(0x9f) ++ Seq.fill(15)(Seq(0xcb) ++ Seq.fill(8)(0)).flatten
    assertRefused(limits, "a message of at least 109 bytes; at most 100 are accepted")(bytes*)

  test("nesting is accepted up to the limit and refused beyond it"):
    def nested(levels: Int) = (1 until levels).foldLeft(Arr(Null))((inner, _) => Arr(inner))
    assertAccepted(FrameLimits(depth = 10), nested(10))
    assertRefused(FrameLimits(depth = 10), "nested deeper than 10 levels")(Seq.fill(11)(0x91)*)

  test("a header with more elements than the limit is refused, and map entries count twice"):
    assertAccepted(FrameLimits(elements = 6), Arr(Null, Obj(Null -> Null), Null, Null))
    assertRefused(FrameLimits(elements = 6), "a message of at least 7 values; at most 6 are accepted")(
      0x91,
      0x83,
      0xc0,
      0xc0
    )
    assertRefused(FrameLimits(), "a message of at least 4294967295 values; at most 4194304 are accepted")(
      0xdd, 0xff, 0xff, 0xff, 0xff
    )

  test("a map with too many keys is refused at its header, so that keys with equal hashes cost little"):
    assertAccepted(FrameLimits(keys = 2), Obj(Str("a") -> Null, Str("b") -> Obj(Null -> Null)))
    assertRefused(FrameLimits(keys = 2), "a map of 3 keys; at most 2 are accepted")(0x83)
    assertRefused(FrameLimits(), "a map of 40000 keys; at most 128 are accepted")(
      0x94, 0x00, 0xde, 0x9c, 0x40
    )
    assertRefused(FrameLimits(), "a map of 65536 keys; at most 128 are accepted")(0xdf, 0, 1, 0, 0)

  test("empty maps count towards a limit, because each is one byte but becomes an object"):
    assertAccepted(FrameLimits(maps = 2), Arr(Obj(), Obj()))
    assertRefused(FrameLimits(maps = 2), "a message of at least 3 maps; at most 2 are accepted")(
      0x93,
      0x80,
      0x80,
      0x80
    )

  test("the bytes held for an unfinished message, and the memory of a decoded one, are reported"):
    val framer = Framer()
    val frame  = ByteString(Wire.pack(Arr(Binary(new Array[Byte](5000)), Obj(), Null)))
    framer.offer(frame.take(3000))
    assertEquals((framer.next(), framer.heldBytes), (Framed.NeedsMore, 3000))
    framer.offer(frame.drop(3000))
    assert(framer.next().isInstanceOf[Framed.Complete])
    assertEquals(framer.heldBytes, 0)
    assertEquals(framer.decodedBytes, frame.length + 3 * 32L + 160)

  test("counts start again with each message"):
    val framer = Framer(FrameLimits(elements = 4, frameBytes = 8))
    val found  = Wire.framed(framer, Seq.fill(100)(ByteString(Wire.pack(Arr(Null, Null, Null)))))
    assertEquals(found.count(_.isInstanceOf[Framed.Complete]), 100)

  private def assertAccepted(limits: FrameLimits, msg: Msg): Unit =
    assertEquals(
      texts(Wire.framed(Framer(limits), Seq(ByteString(Wire.pack(msg))))),
      Seq(hex(Wire.pack(msg)))
    )

  private def assertRefused(limits: FrameLimits, reason: String)(bytes: Int*): Unit =
    assertEquals(
      Wire.framed(Framer(limits), bytes.map(b => ByteString(b.toByte))),
      Seq(Framed.Malformed(reason))
    )

  private def texts(found: Seq[Framed]): Seq[String] = found.map:
    case Framed.Complete(bytes) => hex(bytes)
    case other                  => other.toString

  private def hex(bytes: Array[Byte]): String = java.util.HexFormat.of().formatHex(bytes)

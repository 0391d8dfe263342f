package skein.mavlink

import java.util.HexFormat
import scala.io.Source

/** Frames and values made by pymavlink; `pymavlink.py`, in their folder, makes them. */
class PymavlinkGolden extends munit.FunSuite:
  private case class Made(name: String, isSigned: Boolean, bytes: Array[Byte], fields: Vector[String])

  private val made =
    val file = Source.fromResource("mavlink/pymavlink.txt")
    try
      file.getLines().map(_.split(' ')).map(words =>
        Made(words(0), words(1) == "signed", HexFormat.of().parseHex(words(2)), words.drop(3).toVector)
      ).toVector
    finally file.close()

  private def shown(field: Any): String = field match
    case value: Float   => s"${java.lang.Float.floatToRawIntBits(value)}"
    case values: Seq[?] => values.map(shown).mkString(",")
    case ""             => "-"
    case other          => other.toString

  private def key = Array.tabulate[Byte](32)(_.toByte)

  private def signing = Signing(key, 7, () => 1234567890123L)

  test("every message has the published number, and the published checksum follows from its name and fields"):
    assertEquals(made.map(_.name).toSet, Dialect.all.map(_.name).toSet)
    for one <- made if !one.isSigned do
      assertEquals(
        FrameReader().read(one.bytes).map(frame => Dialect.of(frame.message).name),
        Vector(one.name)
      )

  test("every field is read with pymavlink's value"):
    val signed = signing
    for one <- made do
      val frame = FrameReader(Option.when(one.isSigned)(signed)).read(one.bytes).head
      assertEquals((frame.system, frame.component, frame.isSigned), (42, 191, one.isSigned))
      assertEquals(
        frame.message.productIterator.map(shown).toVector.take(one.fields.size),
        one.fields,
        one.name
      )

  test("a frame that was read is written with equal bytes, including its signature"):
    val (reading, writing) = (signing, signing)
    val (plain, signed)    = (FrameWriter(42, 191), FrameWriter(42, 191, Some(writing)))
    for one <- made do
      val frame   = FrameReader(Option.when(one.isSigned)(reading)).read(one.bytes).head
      val written = (if one.isSigned then signed else plain).write(frame.message)
      // The writers count from 0, pymavlink through both.
      val body = (bytes: Array[Byte]) =>
        HexFormat.of().formatHex(bytes.drop(5).dropRight(if one.isSigned then 15 else 2))
      assertEquals(body(written), body(one.bytes), one.name)

package skein.recognition

import java.io.ByteArrayOutputStream
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.Path
import skein.airsim.{Image, Pixels, Shot}
import skein.rpc.Bytes
import skein.units.*

class OnnxModelSuite extends munit.FunSuite:
  private lazy val model = OnnxModel.read(TinyModel.brightest).fold(fail(_), identity)

  override def afterAll(): Unit = model.close()

  /** A grey image of value 10, with one pixel of the given blue, green, red. */
  private def image(blue: Int, green: Int, red: Int): Image =
    val bytes = Array.fill[Byte](8 * 4 * 3)(10)
    bytes(33) = blue.toByte
    bytes(34) = green.toByte
    bytes(35) = red.toByte
    Image(Shot("0"), 8, 4, Pixels.Bgr(Bytes(bytes, 0, bytes.length)), Vector3.Zero, Quaternion.Identity)

  test("a model is run on an image, with channels in the order of its training"):
    val form                       = InputForm(8, 4, scale = (1, 1, 1))
    def brightest(form: InputForm) = model.run(image(50, 100, 200), form).map(_("y").values.toSeq)
    assertEquals(brightest(form), Right(Seq(200f, 100f, 50f)))
    assertEquals(brightest(form.copy(redFirst = false)), Right(Seq(50f, 100f, 200f)))
    assertEquals(
      brightest(form.copy(mean = (100, 0, 0), scale = (0.5f, 1, 2))),
      Right(Seq(50f, 100f, 100f))
    )
    assertEquals(model.run(image(1, 2, 3), form).map(_("y").shape), Right(Vector(1, 3, 1, 1)))

  test("an image of another size is scaled to the model's size"):
    val small = InputForm(2, 2).tensor(image(0, 0, 0)).fold(fail(_), identity)
    assertEquals(small.length, 12)
    assertEquals(small.map(value => math.round(value * 255)).toSeq.distinct, Seq(10))

  test("an invalid model, and an invalid input, are reported"):
    assert(OnnxModel.read(Array[Byte](1, 2, 3)).isLeft)
    assertEquals(
      OnnxModel.load(Path.of("missing.onnx")).left.map(identity),
      Left("missing.onnx: expected an ONNX model, there is no such file")
    )
    assert(model.run(new Array[Float](6), Vector(1, 2, 3)).isLeft)
    assertEquals(
      model.run(new Array[Float](5), Vector(1, 2, 3)).left.toOption,
      Some("expected 1 × 2 × 3 numbers, got 5")
    )

/** A model of one node, written by hand: the largest value of each channel. ONNX's messages are protocol
  * buffers.
  */
private object TinyModel:
  val brightest: Array[Byte] =
    val node  = field(1, text(1, "x") ++ text(2, "y") ++ text(4, "GlobalMaxPool"))
    val graph = node ++ text(2, "brightest") ++ field(11, value("x")) ++ field(12, value("y"))
    number(1, 8) ++ field(7, graph) ++ field(8, text(1, "") ++ number(2, 13))

  private def value(name: String): Array[Byte] =
    val free  = (1 to 2).flatMap(i => field(1, text(2, s"$name$i"))).toArray
    val shape = field(1, number(1, 1)) ++ field(1, number(1, 3)) ++ free
    text(1, name) ++ field(2, field(1, number(1, 1) ++ field(2, shape)))

  private def number(tag: Int, value: Int): Array[Byte]        = Array((tag << 3).toByte, value.toByte)
  private def text(tag: Int, value: String): Array[Byte]       = field(tag, value.getBytes(UTF_8))
  private def field(tag: Int, bytes: Array[Byte]): Array[Byte] =
    val out = ByteArrayOutputStream()
    out.write(tag << 3 | 2)
    if bytes.length >= 128 then out.write(bytes.length & 0x7f | 0x80)
    out.write(if bytes.length >= 128 then bytes.length >> 7 else bytes.length)
    out.writeBytes(bytes)
    out.toByteArray

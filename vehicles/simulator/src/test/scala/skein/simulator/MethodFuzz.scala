package skein.simulator

import scala.util.Random
import scala.util.control.NonFatal
import upack.*

/** Invalid calls of every method in the simulator's table: each parameter in turn is nil, of another type,
  * not finite, huge, deeply nested; some are missing, some surplus. A parameter's own reader determines valid
  * values, so a new method is fuzzed as soon as it is in the table.
  */
private[simulator] object MethodFuzz:

  final case class FuzzCall(method: String, params: Seq[Msg])

  /** @param methods the table
    * @param vehicle the name of a vehicle that exists
    */
  final class Calls(methods: Seq[ServerMethod], vehicle: String):
    private val palette = plain(vehicle) ++ nested(vehicle)
    private val right   = methods.map: method =>
      method.arguments.map(argument => palette.filter(accepts(argument, _)).toIndexedSeq)
    private val wrong = (palette ++ extreme).toIndexedSeq

    /** Vehicle names after such calls: some add a vehicle. */
    def names: Seq[Msg] = palette.collect { case name: Str => name }

    for (method, values) <- methods.zip(right); (found, i) <- values.zipWithIndex do
      require(found.nonEmpty, s"nothing in the palette is right for parameter $i of ${method.name}")

    /** Every method with each of its parameters in turn replaced by each invalid value, the others valid. */
    def each: Iterator[FuzzCall] =
      for
        (method, values) <- methods.iterator.zip(right)
        i                <- values.indices.iterator
        value            <- wrong.iterator
      yield FuzzCall(method.name, values.map(_.head).updated(i, value))

    def random(random: Random): FuzzCall =
      val which  = random.nextInt(methods.size)
      val method = methods(which)
      val values = right(which)
      def any    = wrong(random.nextInt(wrong.size))
      val usual  = values.map(from => from(random.nextInt(from.size)))
      val params = random.nextInt(10) match
        case 0 | 1              => usual
        case 2                  => usual.take(random.nextInt(usual.size + 1))
        case 3                  => usual ++ Seq.fill(1 + random.nextInt(4))(any)
        case 4                  => usual.map(_ => any)
        case _ if usual.isEmpty => usual
        case _                  => usual.updated(random.nextInt(usual.size), any)
      FuzzCall(if random.nextInt(200) == 0 then random.nextString(5) else method.name, params)

  /** Whether an answer's text is evidence of a defect rather than of an invalid call. */
  def isDefect(error: String): Boolean =
    error.contains("information: java.") || error.contains("information: scala.") ||
      error.contains("information: skein.") || error.contains("information: upickle.") ||
      error.contains("information: upack.")

  private def accepts(argument: Argument[?], value: Msg): Boolean =
    try
      argument.read(value)
      true
    catch case NonFatal(_) => false

  private def plain(vehicle: String): Seq[Msg] = Seq(
    Int32(0),
    Int32(1),
    Float32(0.5f),
    Str(vehicle),
    Str(""),
    Bool(false),
    Bool(true),
    Binary(vehicle.getBytes),
    Arr(),
    Obj(),
    Null,
    Int32(-1),
    Int32(Int.MaxValue),
    Int32(Int.MinValue),
    Int64(Long.MaxValue),
    Int64(Long.MinValue),
    UInt64(-1),
    Float32(-0f),
    Float32(Float.MinPositiveValue),
    Float32(Float.MaxValue),
    Float32(Float.NaN),
    Float32(Float.PositiveInfinity),
    Float64(1e-300),
    Float64(-1e300),
    Float64(1e9),
    Float64(Double.NaN),
    Float64(Double.NegativeInfinity),
    Str("nosuch"),
    Str("\u0000\ud800é漢🛩"),
    Ext(5, Array(1, 2, 3))
  )

  private def nested(vehicle: String): Seq[Msg] =
    def vector(x: Msg) = Obj(Str("x_val") -> x, Str("y_val") -> Float32(2), Str("z_val") -> Float32(-3))
    def request(kind: Msg, floats: Msg) = Obj(
      Str("camera_name")     -> Str("3"),
      Str("image_type")      -> kind,
      Str("pixels_as_float") -> floats,
      Str("compress")        -> Bool(false)
    )
    val numbers =
      Seq[Msg](Float32(1), Int32(7), Float32(Float.NaN), Float64(1e300), Null, Str("1"), vector(Null))
    val pose =
      Obj(Str("position") -> vector(Float32(1)), Str("orientation") -> Obj(Str("w_val") -> Float32(1)))
    (-1 to 10).map(kind => Arr(request(Int32(kind), Bool(kind % 2 == 0)))) ++ numbers.map(
      vector
    ) ++ numbers.map(x => Arr(vector(x), vector(Float32(4)))) ++ numbers.map(Arr(_)) ++
      numbers.map(x => Obj(Str("is_rate") -> x, Str("yaw_or_rate") -> x)) ++
      Seq[Msg](
        Arr(request(Null, Bool(true))),
        Arr(request(Int32(0), Int32(1)), Null),
        Arr(Seq.fill(65)(request(Int32(5), Bool(false)))*),
        pose,
        Arr(pose, pose),
        Obj(Str("position") -> Null),
        Obj(Str("position") -> Arr(), Str("orientation") -> pose),
        Obj(Int32(1)        -> Null),
        Obj(Null            -> Obj(Null -> Null)),
        Arr(Arr(Arr())),
        Arr(Str(vehicle), Str(vehicle)),
        Arr(Seq.fill(4)(Float32(0.25f))*)
      )

  /** Values too costly to try with every parameter's reader. */
  private def extreme: Seq[Msg] = Seq(
    Str("x" * 50_000),
    Binary(new Array[Byte](50_000)),
    Arr(Seq.fill(2000)(Obj(Str("x_val") -> Float32(1), Str("y_val") -> Float32(1)))*),
    Arr(Seq.tabulate(2000)(i => Obj(Str("x_val") -> Float32(i.toFloat)))*),
    Arr(Seq.fill(20_000)(Float32(1))*),
    Obj(Str("k0") -> Null, (1 to 100).map(i => Str(s"k$i") -> (Int32(i): Msg))*),
    (1 to 50).foldLeft[Msg](Null)((inner, _) => Arr(inner)),
    (1 to 50).foldLeft[Msg](Null)((inner, _) => Obj(Str("position") -> inner))
  )

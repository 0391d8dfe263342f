package skein.onnx

import java.io.IOException
import java.nio.charset.StandardCharsets.UTF_8
import java.nio.file.{Files, Path}
import java.security.MessageDigest
import java.util.{HexFormat, ServiceLoader}
import scala.jdk.CollectionConverters.*
import skein.onnx.OnnxGraph.{Float32, Port}
import skein.policy.*
import skein.units.{Decimals, Expect}

/** A policy of an ONNX file. Its input and its output are those of environments ([[LearnerSpace]]); the
  * largest turn is one until the next decision (pursuer) or of one decision (evader).
  *
  * @param role the role that the file notes
  * @param family `learned:…` if the network has the form of the networks that Skein trains
  * @param parameters values in the order of the family's axes, for a role
  */
final case class OnnxPolicy(role: Option[String], family: PolicyFamily, parameters: Role => Vector[Double])

object OnnxPolicy:
  val Suffix = ".onnx"

  /** Prefix of the names of policies that an ONNX runtime evaluates. */
  val Prefix = "onnx:"

  private val MostBytes = 64L << 20

  /** Default maximum turn rate of a pursuer, as in environments. */
  private val TurnRateRadPerS = 1.0

  private val RoleNote  = "skein.role"
  private val RateNote  = "skein.turnRateRadPerS"
  private val TurnNote  = "skein.turnRad"
  private val ClimbNote = "skein.climbMps"

  /** Reads a policy file; Left says what was expected, what was found, and where. */
  def read(path: String): Either[String, OnnxPolicy] =
    (for
      file  <- attempted(Path.of(path).toAbsolutePath.normalize)
      bytes <- contents(file)
      graph <- OnnxFormat
        .read(bytes, beside(file))
        .left
        .map(reason => s"expected an ONNX model: $reason")
      space <- spaceOf(graph)
      found <- DenseGraph.network(graph, space) match
        case Right((shape, parameters)) => ours(graph, shape, parameters)
        case Left(reason)               => other(file, bytes, graph, space, reason)
    yield found).left.map(mistake => s"$path: $mistake")

  /** The family of a recorded policy that a runtime evaluated.
    *
    * @return Left says why it is not available any more
    */
  def recorded(name: String): Either[String, PolicyFamily] =
    name.stripPrefix(Prefix).split(":", 2) match
      case Array(digest, written) =>
        val path = java.net.URLDecoder.decode(written, UTF_8)
        read(path).map(_.family).flatMap: family =>
          Either.cond(
            family.name == name,
            family,
            s"$path: expected the file of SHA-256 $digest that decided then, got another"
          )
      case _ => Left(s"expected ${Prefix}SHA-256:FILE, got '$name'")

  /** Writes a network as an ONNX file.
    *
    * @param role the role for which it was trained
    * @return Left says why the policy is not a network
    */
  def write(policy: Policy, role: String): Either[String, Array[Byte]] =
    (policy match
      case learned: LearnedPolicy => Right(learned)
      case neural: NeuralPolicy   => Right(seeingMore(neural))
      case _ => Left("only networks have an ONNX form: families neural:…, learned:… and climbing:…")
    ).map: learned =>
      OnnxFormat.write(DenseGraph.graph(
        learned,
        Map(
          RoleNote -> role,
          RateNote -> learned.turnRateRadPerS.toString,
          TurnNote -> learned.turnRad.toString
        ) ++ Option.when(learned.space.climbs)(ClimbNote -> learned.climbMps.toString)
      ))

  /** An equal network with more inputs, whose weights are zero. */
  private def seeingMore(policy: NeuralPolicy): LearnedPolicy =
    val inputs       = LearnerSpace.Level.inputs
    val first        = policy.shape.widths(1)
    val (seen, rest) = policy.parameters.splitAt(first * (NeuralShape.Inputs + 1))
    val widened      = seen
      .grouped(NeuralShape.Inputs + 1)
      .flatMap(row => row.init ++ Vector.fill(inputs - NeuralShape.Inputs)(0.0) :+ row.last)
    LearnedPolicy(
      policy.shape.copy(inputs = inputs),
      widened.toVector ++ rest,
      policy.turnRateRadPerS,
      0
    )

  private def attempted[A](call: => A): Either[String, A] =
    try Right(call)
    catch case failed: IOException => Left(s"cannot read it: $failed")

  private def contents(file: Path): Either[String, Array[Byte]] =
    for
      _    <- Expect.that(Files.isRegularFile(file))("expected an ONNX model, there is no such file")
      size <- attempted(Files.size(file))
      _    <- Expect.that(size <= MostBytes)(s"expected at most $MostBytes bytes, got $size")
      all  <- attempted(Files.readAllBytes(file))
    yield all

  /** Reads weights from another file in the model's folder. */
  private def beside(file: Path)(name: String, offset: Long, length: Long): Either[String, Array[Byte]] =
    val other = Path.of(name)
    if other.isAbsolute || other.getNameCount != 1 || name == ".." then
      Left(s"expected weights in a file beside it, got '$name'")
    else
      contents(file.resolveSibling(other)).left.map(reason => s"its weights in $name: $reason").flatMap:
        all =>
          val until = if length < 0 then all.length.toLong else offset + length
          Either.cond(
            offset >= 0 && offset <= until && until <= all.length,
            all.slice(offset.toInt, until.toInt),
            s"expected its weights up to byte $until of $name, which has ${all.length}"
          )

  private def spaceOf(graph: OnnxGraph): Either[String, LearnerSpace] =
    def fits(port: Port, numbers: Int) =
      port.shape.forall: shape =>
        val last = shape.lastOption.flatten
        if shape.sizeIs == 1 && numbers > 1 then last.forall(_ == numbers)
        else shape.sizeIs <= 2 && last.forall(_ == numbers) && (shape.sizeIs < 2 || shape.head.forall(_ == 1))
    val isOne = graph.inputs.sizeIs == 1 && graph.outputs.sizeIs == 1
    Seq(LearnerSpace.Level, LearnerSpace.Climbing)
      .find(space =>
        isOne && fits(graph.inputs.head, space.inputs) && fits(graph.outputs.head, space.outputs)
      )
      .toRight:
        "expected one input of shape (batch, 9) and one output of shape (batch, 1), " +
          s"or (batch, 13) and (batch, 2) if it climbs, got ${told("input", graph.inputs)} and ${told("output", graph.outputs)}"

  private def told(what: String, ports: Vector[Port]): String =
    if ports.isEmpty then s"no $what" else s"$what ${ports.map(_.text).mkString(", ")}"

  private def ours(
      graph: OnnxGraph,
      shape: NeuralShape,
      parameters: Vector[Double]
  ): Either[String, OnnxPolicy] =
    Either.cond(
      parameters.forall(_.isFinite),
      OnnxPolicy(
        graph.metadata.get(RoleNote),
        PolicyFamily.learned(shape),
        role => parameters ++ most(graph, role, LearnerSpace.of(shape).climbs)
      ),
      "expected finite weights, got some that are none"
    )

  private def most(graph: OnnxGraph, role: Role, climbs: Boolean): Vector[Double] =
    def note(key: String)  = graph.metadata.get(key).flatMap(_.toDoubleOption).filter(_.isFinite)
    val Vector(rate, turn) = LearnedPolicy.mostTurn(role, TurnRateRadPerS): @unchecked
    Vector(note(RateNote).getOrElse(rate), note(TurnNote).getOrElse(turn)) ++
      Option.when(climbs)(note(ClimbNote).getOrElse(LearnerSpace.ClimbMps))

  /** A model that is not one of Skein's networks, evaluated by a [[skein.policy.ModelRunner]]. */
  private def other(
      file: Path,
      bytes: Array[Byte],
      graph: OnnxGraph,
      space: LearnerSpace,
      why: String
  ): Either[String, OnnxPolicy] =
    val input   = graph.inputs.head
    val runners = ServiceLoader.load(classOf[ModelRunner]).iterator.asScala.toVector
    for
      runner <-
        runners.headOption.toRight(s"it is no dense network ($why), and nothing here runs other models")
      _ <- Expect.that(input.element == Float32):
        s"it is no dense network ($why), and runs on 32-bit floats alone: got input of type ${input.element}"
      model <- runner.load(bytes).left.map(reason => s"it is no dense network ($why): $reason")
      rank  = input.shape.fold(2)(_.size)
      asked = (seen: Array[Float]) => model(seen, Vector(space.inputs).reverse.padTo(rank, 1).reverse)
      _ <- answer(asked, space, 10.0 +: Array.fill(space.inputs - 1)(0.0)).left.map(reason =>
        s"it was tried: $reason"
      )
    yield
      val digest = HexFormat.of.formatHex(MessageDigest.getInstance("SHA-256").digest(bytes))
      val name   = s"$Prefix$digest:${java.net.URLEncoder.encode(file.toString, UTF_8)}"
      val family = PolicyFamily(
        name,
        "a model that a runtime decides for",
        Set(Role.Pursuer, Role.Evader),
        SearchSpace(PolicyFamily.most(space.climbs)),
        numbers => RunPolicy(asked, space, numbers(0), numbers(1), numbers.lift(2).getOrElse(0))
      )
      OnnxPolicy(graph.metadata.get(RoleNote), family, most(graph, _, space.climbs))

  private def answer(
      asked: Array[Float] => Either[String, Array[Float]],
      space: LearnerSpace,
      observed: Array[Double]
  ): Either[String, Array[Double]] =
    asked(observed.map(_.toFloat)).flatMap: shares =>
      if shares.length != space.outputs then
        Left(s"expected ${Decimals.counted(space.outputs, "number")}, got ${shares.length}")
      else
        shares.find(!_.isFinite) match
          case Some(share) => Left(s"expected a number from -1 to 1, got $share")
          case None        => Right(shares.map(_.toDouble.max(-1).min(1)))

  /** A policy that a runtime evaluates; thread-safe. Throws if the model fails or its output is not a number.
    */
  private final class RunPolicy(
      asked: Array[Float] => Either[String, Array[Float]],
      val space: LearnerSpace,
      val turnRateRadPerS: Double,
      val turnRad: Double,
      val climbMps: Double
  ) extends SharesPolicy:
    def shares(observed: Array[Double]): Array[Double] =
      answer(asked, space, observed).fold(
        reason => throw IllegalStateException(s"the policy: $reason"),
        identity
      )

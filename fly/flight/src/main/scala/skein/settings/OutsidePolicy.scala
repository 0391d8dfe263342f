package skein.settings

import java.io.IOException
import java.nio.ByteBuffer
import java.nio.charset.StandardCharsets.UTF_8
import java.util.concurrent.TimeUnit.NANOSECONDS
import java.util.concurrent.{ExecutionException, FutureTask, TimeoutException}
import skein.policy.*
import skein.units.{OwnFailure, Span}

/** A policy in another process, over a Unix socket. It receives the observation of `skein.environment`
  * ([[PlanarObservation.fromOwnHeading]]) and answers with a number from −1 to 1, its share of the largest
  * turn; values beyond are clipped. So a policy that was trained there, with an equal turn rate, runs in
  * every loop.
  *
  * A request is nine 32-bit floats, big-endian. An answer is a byte: 0, and a float; or 1, and why there is
  * none: a length in bytes (32 bits) and UTF-8. There is one unanswered request at a time, of all flights
  * together. The clock of a flight in virtual time stands still meanwhile, so equal answers make equal
  * flights.
  *
  * A decision fails if the policy reports an error, if the number is not finite, if anything but one answer
  * is received, or if none is complete within [[OutsidePolicy.AnswerWithin]] of real time. After the last two
  * the policy receives no more requests, and every later decision fails immediately: a surplus answer would
  * be taken for that to the next request, and all later answers would be off by one.
  *
  * @param byRate whether the largest turn is one per second since the previous decision
  * @param mostTurn that turn, rad/s; otherwise the largest of each decision, rad
  */
final class OutsidePolicy private (connection: OutsidePolicy.Connection, byRate: Boolean, mostTurn: Double)
    extends HeadingPolicy.Memoryless:

  /** Requests a decision.
    *
    * @throws skein.units.OwnFailure if there is no answer
    */
  def heading(seen: PlanarObservation): Double =
    val share = connection.ask(seen.fromOwnHeading.map(_.toFloat)).toDouble.max(-1).min(1)
    seen.ownHeadingRad + share * mostTurn * (if byRate then seen.elapsedS else 1)

object OutsidePolicy:
  private val Name = "outside"

  /** The largest turn rate of a pursuer, from the paper. */
  val MostTurnRadPerS = 1.0

  /** Bounds of the largest turn rate that a policy may have, rad/s. */
  val LeastRateRadPerS = 1e-3
  val MostRateRadPerS  = 50.0

  /** Time-out of an answer: enough for a first one that loads a network. */
  val AnswerWithin: Span = Span.ofSeconds(10)

  private val MostText = 1 << 16

  /** Connects to the policy of a running process.
    *
    * @param text `unix:ROLE:PATH`, or `unix:ROLE@RATE:PATH` with the largest turn rate, rad/s; without it,
    *   that of a pursuer is [[MostTurnRadPerS]], and an evader makes up to half a turn in each decision
    * @return Left says what was expected, what was given, and where
    */
  def reach(text: String, answerWithin: Span = AnswerWithin): Either[String, PolicyFile] = text match
    case s"unix:$who:$path" =>
      for
        (role, rate) <- decider(who).left.map(mistake => s"$text: $mistake")
        connection   <- connected(path, answerWithin).left.map(reason =>
          s"expected a policy behind the socket $path: $reason"
        )
      yield PolicyFile.ofDefaults(role, family(role, rate, connection))
    case _ => Left(s"expected unix:ROLE:PATH, or unix:ROLE@RATE:PATH, got '$text'")

  private def decider(text: String): Either[String, (Role, Option[Double])] = text match
    case s"$role@$rate" =>
      for
        known <- PolicyFile.role(role)
        turn  <- rate.toDoubleOption
          .filter(value => value >= LeastRateRadPerS && value <= MostRateRadPerS)
          .toRight(s"expected a turn rate from $LeastRateRadPerS to $MostRateRadPerS rad/s, got '$rate'")
      yield (known, Some(turn))
    case role => PolicyFile.role(role).map((_, None))

  /** Connects; blocks as long as the other side's queue of connections is full. */
  private def connected(path: String, within: Span): Either[String, Connection] =
    val connecting = FutureTask(() => Connection(path, within))
    Thread.ofPlatform.daemon.name("connect").start(connecting): Unit
    try Right(connecting.get(within.toNanos, NANOSECONDS))
    catch
      case _: TimeoutException        => Left(s"it accepts nobody within ${within.toMillis.round} ms")
      case failed: ExecutionException => Left(failed.getCause.getMessage)

  /** Whether another process decides for this policy. */
  def decides(file: PolicyFile): Boolean = file.family.name == Name

  private def family(role: Role, rate: Option[Double], connection: Connection) =
    val byRate = role == Role.Pursuer || rate.isDefined
    val axis   =
      if byRate then
        Axis("turnRateRadPerS", LeastRateRadPerS, MostRateRadPerS, rate.getOrElse(MostTurnRadPerS))
      else Axis("turnRad", 0, math.Pi, math.Pi)
    PolicyFamily(
      Name,
      "decides in a process of its own",
      Set(role),
      SearchSpace(Vector(axis)),
      parameters => OutsidePolicy(connection, byRate, parameters(0))
    )

  /** A connection, open until the process ends or violates the protocol. */
  private final class Connection(path: String, answerWithin: Span):
    private val socket = ProcessSocket(path, answerWithin)
    private var broken = Option.empty[String]

    def ask(seen: Array[Float]): Float = synchronized:
      val answer = broken.toLeft(()).flatMap: _ =>
        try exchange(seen)
        catch
          case reason: IOException =>
            broken = Some(reason.getMessage)
            socket.close()
            Left(reason.getMessage)
      answer.fold(reason => throw OwnFailure("the policy:", reason), identity)

    private def exchange(seen: Array[Float]): Either[String, Float] =
      val question = ByteBuffer.allocate(4 * seen.length)
      for number <- seen do question.putFloat(number): Unit
      if socket.isAhead then throw IOException("expected one answer to a question, got more")
      socket.ask(question.flip())
      socket.read(1).get match
        case 0 =>
          val share = socket.read(4).getFloat
          Either.cond(share.isFinite, share, s"expected a number from -1 to 1, got $share")
        case 1 =>
          val length = socket.read(4).getInt
          if length < 0 || length > MostText then
            throw IOException(s"expected at most $MostText bytes of text, got $length")
          Left(ProcessSocket.plain(String(socket.read(length).array, UTF_8)))
        case other => throw IOException(s"expected 0 or 1 before an answer, got $other")

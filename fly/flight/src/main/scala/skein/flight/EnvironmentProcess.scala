package skein.flight

import java.io.IOException
import java.nio.ByteBuffer
import java.nio.charset.StandardCharsets.UTF_8
import scala.util.control.NonFatal
import skein.settings.ProcessSocket
import skein.signal.Kinematics
import skein.units.*
import ujson.{Arr, Num, Obj, Value}

/** An environment in another process, behind a Unix socket: that of Python's `skein_uav.simulators`. Each
  * request and each answer is a line of JSON:
  *
  * {{{
  * {}                                               begins an episode
  * {"velocities": {"Evader": [1.0, 0.0, 0.0]}}      one step, each vehicle under this velocity, NED, m/s
  * {"stepS": 0.1, "vehicles": {"Evader": {"body": [north, east, down, their velocities, heading], "reward": 0.5,
  *                                        "terminated": false, "truncated": false
  * }}}
  *
  * {"error": "ValueError: …"} }}}
  *
  * It blocks, up to [[EnvironmentProcess.AnswerWithin]] a call. Not thread-safe.
  *
  * @param names the vehicles' names
  */
final class EnvironmentProcess private (socket: ProcessSocket, names: Vector[String]):
  import EnvironmentProcess.*

  /** Begins an episode.
    *
    * @return Left says what was expected and what was received
    */
  def reset(): Either[String, Moment] = ask(Obj())

  /** Simulates one step under velocities NED, m/s, in the order of the names. */
  def step(velocities: Vector[Vector3]): Either[String, Moment] = ask(Obj(
    "velocities" -> Obj.from(names.zip(velocities.map(v => Arr(v.x, v.y, v.z))))
  ))

  def close(): Unit = socket.close()

  private def ask(question: Obj): Either[String, Moment] =
    try
      socket.ask(ByteBuffer.wrap(s"${question.render()}\n".getBytes(UTF_8)))
      read(ujson.read(line()))
    catch
      case lost: IOException => Left(lost.getMessage)
      case NonFatal(wrong)   => Left(s"expected an environment's answer, got ${wrong.getMessage}")

  private def read(answer: Value): Either[String, Moment] = answer.obj.get("error") match
    case Some(error) => Left(ProcessSocket.plain(error.str))
    case None        =>
      val bodies = names.map: name =>
        val told = answer("vehicles")(name)
        val body = told("body").arr.collect { case Num(number) if number.isFinite => number }
        if body.size != 7 then throw IllegalArgumentException(s"${told("body").render()} of $name")
        val moves = Kinematics(
          Vector3(body(0), body(1), body(2)),
          Vector3(body(3), body(4), body(5)),
          Quaternion.ofYaw(body(6)),
          Vector3.Zero
        )
        Agent(moves, told("reward").num, told("terminated").bool, told("truncated").bool)
      Right(Moment(Span.ofSeconds(answer("stepS").num), bodies))

  private def line(): String =
    val bytes = ByteBuffer.allocate(LongestLine)
    while bytes.position() == 0 || bytes.get(bytes.position() - 1) != '\n' do
      socket.read(bytes)
      if !bytes.hasRemaining then throw IOException(s"expected at most $LongestLine bytes, got more")
    String(bytes.array, 0, bytes.position(), UTF_8)

object EnvironmentProcess:
  /** The state after a step.
    *
    * @param stepS duration of one step
    */
  final case class Moment(step: Span, agents: Vector[Agent])

  /** One vehicle's state.
    *
    * @param reward the last step's reward
    */
  final case class Agent(kinematics: Kinematics, reward: Double, terminated: Boolean, truncated: Boolean)

  /** Time-out of an answer: enough for a first step that compiles. */
  val AnswerWithin: Span = Span.ofSeconds(10)

  private val LongestLine = 1 << 20

  /** Connects to the socket; Left says why that failed. */
  def connect(path: String, names: Vector[String]): Either[String, EnvironmentProcess] =
    try Right(EnvironmentProcess(ProcessSocket(path, AnswerWithin), names))
    catch
      case nobody: IOException =>
        Left(s"expected an environment behind the socket $path: ${nobody.getMessage}")

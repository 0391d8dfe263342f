package skein.simulator

import skein.port.CommandPlan
import skein.rpc.Rpclib
import skein.units.*
import upack.{Arr, Float32, Msg, Str}

/** A call of one of AirSim's functions that move a vehicle, and the time from which it acts.
  *
  * @param at time from which it acts, on the simulator's clock
  * @param params the function's parameters, without the vehicle
  */
private[skein] final case class PlannedMove(at: Instant, method: String, params: Vector[Msg]):

  /** Upper bound of the move's duration; zero for a hover. */
  def lasts: Span = limit.fold(Span.Zero)((_, seconds) => Move.span(seconds))

  /** The rest of this move if it begins `late` after its time and ends when planned; None if none is left. */
  def begun(late: Span): Option[PlannedMove] = limit match
    case None                     => Some(this)
    case Some(_) if late >= lasts => None
    case Some((place, seconds))   =>
      val left = Float32((seconds - late.max(Span.Zero).toSeconds).toFloat)
      Some(copy(params = params.updated(place, left)))

  /** Index and value, in seconds, of the parameter that is the move's duration or time limit. */
  private def limit: Option[(Int, Float)] =
    for
      place   <- PlannedMove.limits.get(method)
      param   <- params.lift(place)
      seconds <- PlanCall.read[Float](param)
    yield (place, seconds)

private[skein] object PlannedMove:
  /** The end of a plan: the vehicle holds its position. */
  def hover(at: Instant): PlannedMove = PlannedMove(at, "hover", Vector.empty)

  private[simulator] val limits: Map[String, Int] =
    Map("takeoff" -> 0, "land" -> 0, "goHome" -> 0, "rotateToYaw" -> 1, "rotateByYawRate" -> 1) ++
      Map("moveOnPath" -> 2, "moveToZ" -> 2, "moveByManual" -> 3, "moveToPosition" -> 4, "moveToGPS" -> 4) ++
      Seq("", "Z", "BodyFrame", "ZBodyFrame").map(form => s"moveByVelocity$form" -> 3) ++
      Seq("Z", "Throttle").flatMap(last =>
        Seq("RollPitchYaw", "RollPitchYawrate", "AngleRates").map(first => s"moveBy$first$last" -> 4)
      ) + ("moveByMotorPWMs" -> 4)

  private[simulator] given Argument[PlannedMove] =
    case Arr(values) if values.size == 3 =>
      PlannedMove(
        summon[Argument[Instant]].read(values(0)),
        summon[Argument[String]].read(values(1)),
        values(2) match
          case Arr(params) => params.toVector
          case _           => throw BadArgument("expected a list of parameters")
      )
    case _ => throw BadArgument("expected a moment, a function's name and its parameters")

/** A call that gives a vehicle a plan, read as far as possible without knowing the vehicle. The built-in
  * simulator accepts it, and so does a buffer in front of another simulator.
  */
private[skein] final case class PlanCall(sequence: Long, moves: Vector[PlannedMove], vehicle: String):

  /** The reason why these moves do not form a plan; None if they do. */
  private[simulator] def mistake: Option[String] =
    CommandPlan.mistake(moves.map(_.at)).orElse(moves.flatMap(wrong).headOption)

  private def wrong(move: PlannedMove): Option[String] = PlanCall.functions.get(move.method) match
    case None           => Some(s"expected a function that moves, got '${move.method}'")
    case Some(function) =>
      Option.unless(function.takes(move.params :+ Str(vehicle)))(s"wrong parameters of ${move.method}")

private[skein] object PlanCall:
  /** The function's name, which no function of AirSim has. */
  val Function = "skeinFollowPlan"

  /** The functions that move a multirotor, by their names. */
  private[simulator] lazy val functions: Map[String, ServerMethod] =
    MoveMethods.all.map(function => function.name -> function).toMap

  def isMove(method: String): Boolean = functions.contains(method)

  /** Reads the parameters of a call; `Left` is the text of the error that the built-in simulator answers. */
  def of(params: IndexedSeq[Msg]): Either[String, PlanCall] =
    if params.size != Arity then Left(Rpclib.arity(Function, passed = params.size, wanted = Arity))
    else
      val call: Either[String, PlanCall] =
        try
          Right(PlanCall(
            summon[Argument[Argument.Unsigned32]].read(params(0)),
            summon[Argument[Seq[PlannedMove]]].read(params(1)).toVector,
            summon[Argument[String]].read(params(2))
          ))
        catch case bad: BadArgument => Left(bad.getMessage)
      call.flatMap(read => read.mistake.toLeft(read)).left.map(refusal)

  /** The error's text for a plan that is refused. */
  def refusal(reason: String): String = Rpclib.threw(Function, Arity, reason)

  /** The reason that AirSim's server states in an error's text; the whole text if it has another form. */
  def reasonIn(error: String): String = Rpclib.information(error).getOrElse(error)

  private[simulator] def read[A](param: Msg)(using argument: Argument[A]): Option[A] =
    try Some(argument.read(param))
    catch case _: BadArgument => None

  private val Arity = 3

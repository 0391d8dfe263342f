package skein.simulator

import scala.collection.mutable
import scala.collection.mutable.ArrayBuffer
import skein.airsim.VehicleSettings
import skein.rpc.{Encoded, RpcRequest, Rpclib}
import skein.units.*
import upack.{Bool, Msg}

/** A received call; `token` identifies its answer. The caller is the request's connection: see
  * [[Simulation.depart]].
  */
final case class SimulatorCall(token: Long, request: RpcRequest):
  export request.{connection as client, method, params}

/** The answer to a call: its result, a deferred result, or the text of its error. */
final case class SimulatorAnswer(token: Long, result: Either[String, Msg | Encoded | DeferredResult])

/** A result that takes long to compute, such as an image. It shows the instant of its request, whenever and
  * on whatever thread it is computed.
  */
final class DeferredResult(work: () => Msg | Encoded):
  def result(): Msg | Encoded = work()

/** The whole simulator without sockets and threads: calls go in with the time; answers come out, immediately
  * or when a move ends. Deterministic: equal calls at equal times give equal answers.
  *
  * The simulator's own clock is the world's. While it runs, it advances with the given time, `speed` times as
  * fast; while it is paused, only as far as calls continue it. A call of `simContinueForTime` is answered as
  * soon as physics has been computed, which is far sooner than the time it advances by; AirSim takes that
  * time on the wall clock.
  *
  * @param startedAt start time on the clock of all later times, and the simulator's clock at that instant
  */
final class Simulation(
    val settings: SimulatorSettings,
    startedAt: Instant
) extends Simulated:
  import Simulation.*

  private[simulator] val equipment = settings.equipment

  val world: World =
    World(settings.world, startedAt, settings.multirotors, settings.scene, equipment, settings.sensing)

  private[simulator] val objects   = SceneObjects(world)
  private[simulator] val cameras   = Cameras(equipment)
  private[simulator] var recording = false

  /** Ratio of the simulator's clock to the caller's. */
  private[simulator] val speed: Double = settings.speed * settings.world.clockSpeed

  private val workers    = settings.newWorkers[SimulatorCall, Waiting]()
  private val answers    = mutable.Queue.empty[SimulatorAnswer]
  private val continuing = ArrayBuffer.empty[Long]
  private var until      = startedAt
  private var paused     = false
  private var lag        = Span.Zero
  private val departed   = mutable.HashSet.empty[Long]
  private var fullSince  = Option.empty[Instant]
  private var heldUp     = Span.Zero

  // The simulator's clock showed `anchored` at `anchoredAt`.
  private var anchoredAt = startedAt
  private var anchored   = startedAt

  /** Whether a call is run as soon as it is received, rather than waiting for a worker. */
  def isFree: Boolean = workers.isFree || isOpen

  /** Whether no call waits behind moves, and the newest move of a vehicle replaces the older immediately:
    * while the clock is paused, and once moves have held all workers for longer than the settings allow.
    */
  private def isOpen = isPaused || hasHeldUp

  /** Whether moves have held all workers for longer than the settings allow, so that they hold none any more.
    */
  def hasHeldUp: Boolean = settings.patience.exists(heldUp >= _)

  /** Receives a call at `at`, no earlier than any time given before. */
  def receive(call: SimulatorCall, at: Instant): Unit =
    // Otherwise every call received during a long step would wait for its share of it.
    if continuing.isEmpty then advance(at)
    if isControl(call.method) then
      workers.drop(other => supersedes(call.request, other.request)).foreach(giveUp)
      run(call, at)
    else workers.offer(call)
    settle(at)

  /** Handles a client that sends no further calls. Its calls no longer hold workers; its vehicles continue
    * its last commands.
    *
    * @param isForgotten whether everything that it sent has arrived
    */
  def depart(client: Long, isForgotten: Boolean, at: Instant): Unit =
    if isForgotten then departed -= client else departed += client
    workers.leave(client).foreach(flight => giveUp(flight.call))
    settle(at)

  /** Answers a call that will not be run, as a cancelled move is answered. */
  private def giveUp(call: SimulatorCall): Unit = answers += SimulatorAnswer(call.token, Right(Bool(false)))

  /** Advances time to `at`. Its work is bounded: while the clock is paused, the rest is done by later calls;
    * else it is skipped, and counted by [[behind]].
    */
  def advance(at: Instant): Unit =
    world.heldTo.foreach(_.told(at))
    for due <- Iterator.continually(workers.nextHandover).takeWhile(_.exists(_ <= at)).flatten do
      runTo(due)
      handOver(due, due)
    runTo(at)
    settle(at)

  /** The latest time for the next [[advance]]. None: not before the next call. */
  def nextWake(at: Instant): Option[Instant] =
    // An awaited autopilot continues the clock with its answer.
    if continuing.nonEmpty then Some(if isHeld then at + KeepUp else at)
    else
      val running =
        if paused then None else Some(world.nextEndAt.fold(at + KeepUp)(wallTime(_).min(at + KeepUp)))
      val handover = workers.nextHandover
      val next     = if running.isEmpty then handover else running.map(end => handover.fold(end)(_.min(end)))
      next.map(_.max(at))

  def takeAnswers(): Seq[SimulatorAnswer] = answers.removeAll()

  def isPaused: Boolean = paused && continuing.isEmpty

  /** The caller's time at which the simulator's clock shows this; None while it is paused. */
  private[simulator] def comesTo(simulated: Instant): Option[Instant] =
    Option.unless(paused || continuing.nonEmpty)(wallTime(simulated))

  /** Simulated time skipped because it was too much to compute in one call, or because an autopilot in
    * lockstep was too slow: the simulator's clock is behind by that much.
    */
  def behind: Span = lag

  private[simulator] def addVehicle(vehicle: VehicleSettings): Unit =
    world.add(vehicle)
    workers.addVehicle()

  private[simulator] def follow(vehicle: Int, sequence: Long, plan: Move.Plan): Unit =
    // A move, and those that wait for its lock, are replaced; the settling after this call answers them.
    workers.dismiss(vehicle, all = true).foreach(flight => giveUp(flight.call))
    world.follow(vehicle, sequence, plan)

  private[simulator] def reset(): Unit =
    world.reset()
    for vehicle <- world.vehicles.indices do
      workers.dismiss(vehicle, all = true).foreach(flight => giveUp(flight.call))

  private[simulator] def setPaused(on: Boolean): Unit =
    paused = on
    if !on then finishStep()

  /** Advances the world to the given time, or as far as calls continue it. */
  private def runTo(at: Instant): Unit =
    if continuing.nonEmpty then
      world.advanceTo(until.min(world.now + longestStretch))
      if world.now >= until then finishStep()
    else if !paused then
      val asked  = world.heldTo.flatMap(_.goal)
      val target = asked.getOrElse(anchored + Span.ofNanos(scaled(at.since(anchoredAt).toNanos, speed)))
      val able   = world.now + longestRun
      world.advanceTo(target.min(able))
      // An autopilot's delay is made up for, up to a bound.
      val behind          = target.since(world.now)
      val madeUpFor: Span = if isHeld then MostMadeUpFor else Span.Zero
      if asked.nonEmpty then anchor(at)
      else if behind > madeUpFor then
        lag = lag + behind - madeUpFor
        anchor(at)
        anchored = anchored + madeUpFor
    if paused || continuing.nonEmpty then anchor(at)

  private def isHeld = world.heldTo.exists(_.isWaiting)

  private def anchor(at: Instant): Unit =
    anchoredAt = at
    anchored = world.now

  private def finishStep(): Unit =
    continuing.foreach(token => answers += SimulatorAnswer(token, Right(upack.Null)))
    continuing.clear()

  /** Answers calls whose moves have ended and runs calls that have become possible, until none is left. */
  private def settle(at: Instant): Unit =
    var again = true
    while again do
      answerEnded(at)
      handOver(at, at)
      val job = workers.take(isOpen)
      job.foreach(run(_, at))
      again = job.nonEmpty || world.hasEnded
    noteHolding(at)

  private def answerEnded(at: Instant): Unit =
    for World.Ended(vehicle, token, result) <- world.takeEnded() do
      answers += SimulatorAnswer(token, Right(Bool(result)))
      workers.release(vehicle, at)

  /** Accumulates the time that moves hold all workers; short bursts do not count. */
  private def noteHolding(at: Instant): Unit =
    for since <- fullSince if settings.patience.isDefined && at.since(since) > Moment do
      heldUp = heldUp + (at.since(since) - Moment)
      fullSince = Some(at - Moment)
    fullSince = if workers.isFull then fullSince.orElse(Some(at)) else None

  /** Starts the moves whose lock arrives by `due`. */
  private def handOver(due: Instant, at: Instant): Unit =
    for (vehicle, waiting) <- Iterator.continually(workers.handOver(due)).takeWhile(_.nonEmpty).flatten do
      start(vehicle, waiting, at)

  private def run(call: SimulatorCall, at: Instant): Unit =
    def fail(text: String): Unit = answers += SimulatorAnswer(call.token, Left(text))
    val forms                    = named.getOrElse(call.method, Vector.empty)
    val those                    = forms.filter(_.arity == call.params.size)
    // Among forms with equally many arguments, the types decide.
    val form =
      if those.size < 2 then those.headOption else those.find(_.takes(call.params)).orElse(those.headOption)
    form match
      case None if forms.isEmpty => fail(Rpclib.unknown(call.method, call.params.size))
      case None                  =>
        fail(Rpclib.arity(call.method, passed = call.params.size, wanted = forms.head.arity))
      case Some(method) =>
        method(this, call.params) match
          case CallOutcome.Answered(result) => answers += SimulatorAnswer(call.token, Right(result))
          case CallOutcome.Draws(work) => answers += SimulatorAnswer(call.token, Right(DeferredResult(work)))
          case CallOutcome.Threw(text) => fail(Rpclib.threw(call.method, call.params.size, text))
          case CallOutcome.Steps(span) => continueFor(span, call.token, at)
          case CallOutcome.Flies(vehicle, order) =>
            val flight = Waiting(call, order)
            if call.method != "hover" then world.forgetPlans(vehicle)
            val wins = isControl(call.method) || isOpen && !settings.losesCancel()
            workers.dismiss(vehicle, all = wins).foreach(flight => giveUp(flight.call))
            if wins then
              world.cancelMove(vehicle)
              answerEnded(at)
            if workers.acquire(vehicle, flight, call.client, departed(call.client)) then
              start(vehicle, flight, at)
            else if !settings.losesCancel() then world.cancelMove(vehicle)

  private def start(vehicle: Int, flight: Waiting, at: Instant): Unit =
    flight.order(world.multirotor(vehicle)) match
      case Right(move) => world.startMove(vehicle, flight.call.token, move)
      case Left(text)  =>
        val call = flight.call
        answers += SimulatorAnswer(call.token, Left(Rpclib.threw(call.method, call.params.size, text)))
        workers.release(vehicle, at)

  /** Starts a stepped advance. It takes far longer than handing over a lock, so moves that wait for one
    * receive it first.
    */
  private def continueFor(span: Span, token: Long, at: Instant): Unit =
    workers.lastHandover.foreach(handOver(_, at))
    val first = continuing.isEmpty
    until = if first then world.now + span else until.max(world.now + span)
    paused = true
    continuing += token
    if first then runTo(at)

  /** The caller's time at which the simulator's clock shows `simulated`. */
  private def wallTime(simulated: Instant): Instant =
    val ahead = simulated.since(anchored).toNanos
    anchoredAt + Span.ofNanos(if speed == 1.0 then ahead else scaled(ahead, 1 / speed) + 1)

  private def scaled(nanos: Long, factor: Double): Long =
    if factor == 1.0 then nanos else (nanos * factor).toLong

  private def longestRun: Span     = stepsOf(LongestRunSteps)
  private def longestStretch: Span = stepsOf(LongestStretchSteps)

  private def stepsOf(all: Int): Span =
    val things = world.vehicles.size.toLong * (1 + world.scene.objects.size / ObjectsOfAStep)
    world.step * (all / things).max(1L)

object Simulation:

  /** A running simulator is advanced at least this often, so that a call never finds much to compute. */
  private val KeepUp = Span.ofMillis(50)

  /** Maximum real time that is made up after an autopilot in lockstep was slower than real time. */
  private val MostMadeUpFor = Span.ofMillis(20)

  /** Holding all workers for less than this does not count. */
  private val Moment = Span.ofMillis(100)

  /** Steps of one vehicle that one call may compute: some 30 ms. */
  private val LongestRunSteps = 200_000

  /** Number of a scene's objects near a vehicle whose check costs as much as the vehicle's step. */
  private val ObjectsOfAStep = 16

  /** Steps computed in one part of a stepped advance: some 4 ms, between which other calls are answered. */
  private val LongestStretchSteps = 30_000

  final private case class Waiting(call: SimulatorCall, order: Move.Order)

  private[simulator] val methods: Seq[ServerMethod] =
    SimulatorMethods.all ++ VehicleMethods.all ++ CarMethods.all ++ MoveMethods.all ++
      PlanMethods.all ++ GainMethods.all ++ SceneMethods.all ++
      CameraMethods.all ++ AppearanceMethods.all ++ CosysMethods.all

  /** All functions by name; AirSim's form before Cosys-AirSim's. */
  private[simulator] val named: Map[String, Seq[ServerMethod]] =
    (methods ++ CosysMethods.forms).groupBy(_.name)

  /** Functions that let a person regain control of a busy simulator, and plans, which hold no worker: they
    * never wait behind moves.
    */
  private val Controls = Set("simPause", "simIsPaused", "ping", "hover", "cancelLastTask", "reset") ++
    Set("getServerVersion", "getMinRequiredClientVersion", "skeinFollowPlan")

  private[simulator] def isControl(method: String): Boolean = Controls(method)

  private val Moves = MoveMethods.all.map(_.name).toSet

  /** Whether a call makes an earlier one, which has not been run, needless: a move before a hover of its
    * vehicle, or before a reset.
    */
  private[simulator] def supersedes(request: RpcRequest, earlier: RpcRequest): Boolean =
    Moves(earlier.method) && earlier.method != "hover" && (request.method == "reset" ||
      request.method == "hover" && request.params.nonEmpty &&
      earlier.params.lastOption == request.params.lastOption)

  val methodNames: Set[String] = named.keySet

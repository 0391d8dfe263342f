package skein.observe

import scala.collection.mutable
import skein.signal.{ClockAlignment, Stamped}
import skein.units.*

/** Analyses a loop from the messages between its program and the simulator. Mutable; one thread at a time;
  * messages in the order in which they passed.
  *
  * A command is assumed to be based on the newest reading of each vehicle whose answer has passed before it.
  * A reading's age counts from its time stamp, by the clocks' estimated offset ([[ClockAlignment]]); an
  * answer without one is assumed to have been sampled halfway between call and answer, which bounds its age
  * as well. The reading of a vehicle or object that is never commanded counts as others' data for as long as
  * the program goes on reading it.
  *
  * Memory: [[LoopAccount.MostPending]] unanswered calls a connection, [[LoopAccount.MostVehicles]] vehicles,
  * [[LoopAccount.MostMethods]] methods, a million samples of each quantity, and [[LoopAccount.MostLogged]]
  * commands.
  */
final class LoopAccount:
  import LoopAccount.*

  private val connections = mutable.LongMap.empty[Open]
  private val vehicles    = Kept[Vehicle](MostVehicles)
  private val methods     = Kept[Method](MostMethods)
  private val outstanding = Array.ofDim[Int](CallKind.values.length)
  private val spentNs     = mutable.LinkedHashMap.from(Phases.map(_ -> 0L))
  private val stalls      = mutable.ArrayBuffer.empty[Stall]
  private val lost        = mutable.ArrayBuffer.empty[String]
  private val quiet       = Samples()
  private val beside      = Samples()
  private val log         = mutable.ArrayBuffer.empty[ObservedCommand]

  private var opened         = 0
  private var clock          = Option.empty[ClockAlignment]
  private var stamps         = Option.empty[Stamps]
  private var backwards      = 0L
  private var stillNs        = 0L
  private var begunAt        = Option.empty[Instant]
  private var lastAt         = Instant.Epoch
  private var periodsNs      = Map.empty[String, Long]
  private var reads, overlap = 0L
  private var imagesInLoop   = 0L
  private var pauses         = 0L
  private var forgotten      = 0L

  def add(passed: Passed): Unit = passed match
    case Passed.Opened(connection, at) =>
      opened += 1
      connections(connection) = Open()
    case called: Passed.Called                     => tick(called.at); call(called)
    case answered: Passed.Answered                 => tick(answered.at); answer(answered)
    case Passed.Unreadable(connection, reason, at) =>
      tick(at)
      // Answers to them will not be seen.
      for open <- connections.get(connection) do
        open.pending.values.foreach(forget)
        open.pending.clear()
      if lost.size < MostLost then lost += s"connection $connection: $reason"
    case Passed.Closed(connection, at) =>
      tick(at)
      for open <- connections.remove(connection) do
        for pending <- open.pending.values do
          if pending.kind == CallKind.Move then vehicle(pending.vehicle).foreach(_.account.leftRunning += 1)
          forget(pending)

  /** Counts messages that passed without analysis. */
  def passedOver(count: Long): Unit = forgotten += count

  /** Attributes the elapsed time to the call that the program waits for. */
  private def tick(at: Instant): Unit =
    if begunAt.isEmpty then begunAt = Some(at)
    else spentNs(phase) += at.since(lastAt).toNanos.max(0)
    lastAt = lastAt.max(at)

  private def phase: String =
    def waitsFor(kind: CallKind) = outstanding(kind.ordinal) > 0
    if waitsFor(CallKind.Image) then Phases(0)
    else if waitsFor(CallKind.State) then Phases(1)
    else if waitsFor(CallKind.Sensor) then Phases(2)
    else if waitsFor(CallKind.Other) || waitsFor(CallKind.Time) then Phases(3)
    else Phases(4)

  private def call(called: Passed.Called): Unit =
    val kind    = CallKind.of(called.method)
    val pending = Pending(called.method, kind, called.vehicle, called.at)
    val open    = connections.getOrElseUpdate(called.connection, Open())
    if open.pending.size >= MostPending then
      forgotten += 1
      open.pending.remove(open.pending.head._1).foreach(forget)
    open.pending.put(called.id, pending).foreach(forget)
    open.last = Some(pending)
    method(called.method, kind).foreach(_.calls += 1)
    if kind == CallKind.State then
      reads += 1
      if outstanding(CallKind.State.ordinal) > 0 then overlap += 1
    if kind == CallKind.Image then open.images += 1
    if kind == CallKind.Time then pauses += 1
    if kind == CallKind.Move then move(called, pending, open)
    pending.besideImages = outstanding(CallKind.Image.ordinal) > 0
    outstanding(kind.ordinal) += 1

  /** Removes a call that is no longer awaited. */
  private def forget(pending: Pending): Unit =
    outstanding(pending.kind.ordinal) -= 1
    if pending.kind == CallKind.Move then
      vehicle(pending.vehicle).foreach(_.inFlight.remove(pending): Unit)

  private def move(called: Passed.Called, pending: Pending, open: Open): Unit =
    if commands == 0 then for phase <- Phases do spentNs(phase) = 0
    else periodsNs = spentNs.toMap
    imagesInLoop += open.images
    open.images = 0
    for commanded <- vehicle(called.vehicle) do
      val at                      = called.at
      val rest                    = vehicles.all.filterNot(_ eq commanded).toVector
      def sinceMs(last: Instant)  = at.since(last).toMillis
      def ageMs(reading: Reading) = reading.ageAt(at, clock).toMillis
      val own                     = commanded.reading.map(ageMs)
      val others  = rest.filter(_.isUsed(at, commanded.account.commandedAt)).flatMap(_.reading).map(ageMs)
      val command = ObservedCommand(
        at.since(begunAt.getOrElse(at)),
        called.vehicle,
        called.method,
        called.connection,
        own,
        others.maxOption,
        commanded.reading.map(_.bound(clock).toMillis),
        commanded.account.commandedAt.map(sinceMs),
        rest.flatMap(_.account.commandedAt).maxOption.map(sinceMs),
        Some(outstanding.sum + 1)
      )
      if log.size < MostLogged then log += command
      commanded.account.add(command, at, others ++ own)
      commanded.inFlight.add(pending): Unit
      commanded.account.mostInFlight = commanded.account.mostInFlight.max(commanded.inFlight.size)

  private def answer(answered: Passed.Answered): Unit =
    for
      open    <- connections.get(answered.connection)
      pending <- open.pending.remove(answered.id)
    do
      val roundTrip = answered.at.since(pending.at)
      for known <- method(pending.method, pending.kind) do
        for error <- answered.error do
          known.failed += 1
          if known.firstError.isEmpty then known.firstError = Some(error)
        known.answerBytes += answered.bytes
        if pending.kind != CallKind.Move then stalled(pending, roundTrip, known, answered.at)
        known.roundTrips.add(roundTrip.toMillis)
      if answered.bytes < SmallBytes && pending.kind != CallKind.Move && pending.kind != CallKind.Image then
        (if pending.besideImages then beside else quiet).add(roundTrip.toMillis)
      if pending.kind == CallKind.Move then
        ended(pending, roundTrip, isAlone = open.last.contains(pending), answered.error.isEmpty)
      else if answered.error.isEmpty then read(pending, answered)
      forget(pending)

  /** Handles the end of a move.
    *
    * @param isAlone whether its connection has sent nothing since
    * @param hasFlown whether the simulator did not refuse it
    */
  private def ended(pending: Pending, roundTrip: Span, isAlone: Boolean, hasFlown: Boolean): Unit =
    for commanded <- vehicle(pending.vehicle) do
      if isAlone && roundTrip > JoinedFor then commanded.account.joined += 1
      // A later command has replaced this one in its time; one that was sent before and still runs arrived
      // after it.
      val isLast = !commanded.inFlight.exists(_.at > pending.at)
      if hasFlown && isLast && !Immediate(pending.method) && commanded.inFlight.exists(_.at < pending.at) then
        commanded.account.overtaken += 1

  private def read(pending: Pending, answered: Passed.Answered): Unit =
    // A sensor's time stamp is when it measured: a scan or a contact may be seconds old.
    if pending.kind == CallKind.State then
      answered.sampledAt.map(Stamped((), _, pending.at, answered.at)).foreach(stamped)
      for seen <- vehicle(pending.vehicle) do
        val reading = Reading(pending.at, answered.at, answered.sampledAt)
        if seen.reading.forall(reading.isNewerThan) then
          seen.readEvery = seen.reading.map(before => reading.receivedAt.since(before.receivedAt))
          seen.reading = Some(reading)

  private def stamped(one: Stamped[Unit]): Unit =
    clock = Some(clock.fold(ClockAlignment.of(one))(_.updated(one)))
    for before <- stamps do
      val isLater = one.sentAt > before.receivedAt
      if isLater && one.validAt < before.validAt then backwards += 1
      if isLater && one.validAt == before.validAt && one.sentAt > before.receivedAt + ClockAlignment.Tick &&
        pauses == 0
      then stillNs += one.sentAt.since(before.receivedAt).toNanos
    val first = stamps.fold((one.validAt, one.receivedAt))(_.first)
    if stamps.forall(one.sentAt > _.receivedAt) then
      stamps = Some(Stamps(first, one.validAt, one.receivedAt))

  private def stalled(pending: Pending, roundTrip: Span, known: Method, at: Instant): Unit =
    if roundTrip > LeastStall && known.roundTrips.added >= UsualAfter &&
      roundTrip.toMillis > StallFactor * known.usualMs
    then
      val end   = at.since(begunAt.get)
      val stall = Stall(end, roundTrip, pending.method)
      // Calls that began during a stall belong to it.
      stalls.lastOption match
        case Some(last) if end - roundTrip < last.at =>
          stalls(stalls.size - 1) = if roundTrip > last.length then stall else last.copy(at = end)
        case _ => if stalls.size < MostStalls then stalls += stall

  private def vehicle(name: String): Option[Vehicle] = vehicles.get(name)(Vehicle(name))

  private def method(name: String, kind: CallKind): Option[Method] = methods.get(name)(Method(name, kind))

  private def commands: Long = vehicles.all.map(_.account.commands).sum

  /** The progress, at constant cost for any number of observations. */
  def progress: Progress =
    VehicleAccount.progress(begunAt.fold(Span.Zero)(lastAt.since), vehicles.all.map(_.account))

  /** Commands since the last call, for each vehicle. */
  def takeNew(): Vector[NewCommands] = vehicles.all.flatMap(_.account.takeNew()).toVector

  /** The complete observations so far; sorts every sample. */
  def observed: Observed =
    val periods = vehicles.all.map(_.account.commands).maxOption.getOrElse(0L) - 1
    Observed(
      lasted = begunAt.fold(Span.Zero)(lastAt.since),
      connections = opened,
      vehicles = vehicles.all.map(_.account.observed).toVector,
      methods = methods.all.map(_.observed).toVector,
      periodMs =
        if periods < 1 then Map.empty else periodsNs.map((phase, ns) => phase -> ns * 1e-6 / periods),
      clock = stamps.map: known =>
        val wall = known.receivedAt.since(known.first._2).toSeconds
        val rate = if wall > 0 then known.validAt.since(known.first._1).toSeconds / wall else 1.0
        SimulatorClock(rate, backwards, Span.ofNanos(stillNs))
      ,
      stalls = stalls.sortBy(-_.length.toNanos).toVector,
      smallCallMs = (quiet = quiet.distribution, besideImages = beside.distribution),
      readsOverlap = if reads == 0 then 0 else overlap.toDouble / reads,
      imagesOnCommandConnections = imagesInLoop,
      pauses = pauses,
      lost = lost.toVector,
      notKept = forgotten,
      log = log.toVector
    )

object LoopAccount:
  /** Activities of a program between two commands, distinguished by the awaited call. */
  val Phases: Vector[String] =
    Vector("images", "states", "sensors", "other calls", "the program itself, or waiting for moves")

  private val MostPending  = 4096
  private val MostVehicles = 256
  private val MostMethods  = 256
  private val MostStalls   = 1000

  /** Twenty vehicles at 20 Hz for eight minutes, in some 30 MB. */
  val MostLogged = 200_000

  private val MostLost = 100

  /** Maximum size of a small answer, bytes; larger ones occupy a link for a while. */
  private val SmallBytes = 16L << 10

  /** Number of usual intervals without a reading after which a program has stopped reading. */
  private val MissedReads = 3

  /** Duration from which a move counts as awaited by the program. */
  private val JoinedFor = Span.ofMillis(50)

  /** Commands that are answered before the end of the move that they replace. */
  private val Immediate = Set("hover", "setCarControls")

  private val LeastStall  = Span.ofMillis(250)
  private val UsualAfter  = 20L
  private val StallFactor = 5.0

  private final class Pending(
      val method: String,
      val kind: CallKind,
      val vehicle: String,
      val at: Instant
  ):
    /** Whether an image call was unanswered when it was sent. */
    var besideImages = false

  private final class Open:
    val pending = mutable.LinkedHashMap.empty[Long, Pending]
    var last    = Option.empty[Pending]

    /** Image calls since the last command. */
    var images = 0L

  private final case class Stamps(first: (Instant, Instant), validAt: Instant, receivedAt: Instant)

  /** A reading that passed.
    *
    * @param sampledAt time of sampling on the simulator's clock, if the answer has a time stamp
    */
  private final case class Reading(sentAt: Instant, receivedAt: Instant, sampledAt: Option[Instant]):

    def isNewerThan(other: Reading): Boolean = (sampledAt, other.sampledAt) match
      case (Some(own), Some(of)) if sentAt <= other.receivedAt => own > of
      case _                                                   => sentAt > other.sentAt

    def ageAt(now: Instant, clock: Option[ClockAlignment]): Span =
      val sampled = for at <- sampledAt; known <- clock yield known.toController(at)
      now.since(sampled.getOrElse(receivedAt - receivedAt.since(sentAt) / 2))

    /** Half width of the age's uncertainty. */
    def bound(clock: Option[ClockAlignment]): Span =
      (for _ <- sampledAt; known <- clock yield known.uncertainty)
        .getOrElse(receivedAt.since(sentAt) / 2)

  private final class Vehicle(name: String):
    val account  = VehicleAccount(name)
    val inFlight = mutable.LinkedHashSet.empty[Pending]
    var reading  = Option.empty[Reading]

    // Between the last two readings.
    var readEvery = Option.empty[Span]

    /** Whether commands to another vehicle are assumed to use its newest reading.
      *
      * @param since when the other vehicle was commanded before
      */
    def isUsed(now: Instant, since: Option[Instant]): Boolean =
      account.commands > 0 || reading.exists: newest =>
        since.forall(newest.receivedAt > _) ||
          readEvery.exists(every => now.since(newest.receivedAt) <= every * MissedReads)

  private final class Method(name: String, kind: CallKind):
    var calls, failed = 0L
    var answerBytes   = 0L
    var firstError    = Option.empty[String]
    val roundTrips    = Samples()
    private var usual = (0L, 0.0)

    def usualMs: Double =
      if roundTrips.added >= 2 * usual._1 then
        usual = (roundTrips.added, roundTrips.distribution.fold(0.0)(_.median))
      usual._2

    def observed: ObservedMethod =
      ObservedMethod(name, kind, calls, failed, roundTrips.distribution, answerBytes, firstError)

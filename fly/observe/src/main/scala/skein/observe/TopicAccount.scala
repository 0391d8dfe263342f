package skein.observe

import scala.collection.mutable
import skein.signal.{ClockAlignment, FastestMessage, Stamped}
import skein.units.{Instant, Span}

/** Analyses a loop from messages of topics: readings of vehicles, and commands to them. Mutable; one thread
  * at a time; messages in the order of their times.
  *
  * A command whose header has the stamp of a reading of its vehicle is caused by that reading; any other is
  * assumed to be based on the newest reading before it. An age counts from the reading's stamp; of a reading
  * without one, from its arrival.
  *
  * If the first stamp of a vehicle is within [[TopicAccount.SameClock]] of the time at which its message
  * arrived, stamps are taken as they are. Otherwise they are by another clock, such as simulated time.
  * Messages in both directions relate the two ([[exchanged]]), with a bound; ages from before the first
  * exchange are left out and counted. Without any, [[skein.signal.FastestMessage]] does: ages lack the
  * latency of the fastest message.
  *
  * Memory: [[TopicAccount.MostVehicles]] vehicles, [[TopicAccount.MostTopics]] topics, a million samples of
  * each quantity, and [[LoopAccount.MostLogged]] commands.
  */
final class TopicAccount:
  import TopicAccount.*

  private val vehicles = Kept[Vehicle](MostVehicles)
  private val topics   = Kept[Topic](MostTopics)
  private val log      = mutable.ArrayBuffer.empty[ObservedCommand]
  private var caused   = 0L
  private var notKept  = 0L
  private var added    = 0L
  private var begunAt  = Option.empty[Instant]
  private var lastAt   = Instant.Epoch

  /** Adds a reading that has arrived.
    *
    * @param stamp its header's stamp
    * @param at time of arrival
    */
  def reading(vehicle: String, topic: String, stamp: Option[Instant], at: Instant): Unit =
    received(vehicle, topic, TopicKind.Readings, stamp, at).foreach(_.read(stamp, at))

  /** Adds a command that was sent; its parameters are those of [[reading]].
    *
    * @param mayBeNow whether its stamp may be its time of sending, so that it identifies no reading
    */
  def command(
      vehicle: String,
      topic: String,
      stamp: Option[Instant],
      at: Instant,
      mayBeNow: Boolean = false
  ): Unit =
    for commanded <- received(vehicle, topic, TopicKind.Commands, stamp, at) do
      val cause = if mayBeNow then None else stamp.flatMap(commanded.readingOf)
      if cause.isDefined then caused += 1
      val rest    = vehicles.all.filterNot(_ eq commanded).toVector
      val own     = cause.orElse(commanded.newest).map(commanded.ageMs(_, at))
      val others  = rest.flatMap(other => other.newest.map(other.ageMs(_, at)))
      val account = commanded.account
      val command = ObservedCommand(
        at.since(begunAt.getOrElse(at)),
        vehicle,
        topic,
        0,
        own,
        others.maxOption,
        commanded.boundMs,
        account.commandedAt.map(at.since(_).toMillis),
        rest.flatMap(_.account.commandedAt).maxOption.map(at.since(_).toMillis)
      )
      if log.size < LoopAccount.MostLogged then log += command
      val isEarly = (commanded +: rest).exists(one => one.newest.isDefined && one.isByOtherClock)
      account.add(command, at, others ++ own, isEarly)

  /** Compares a vehicle's clock with ours.
    *
    * @param sentAt when the request passed
    * @param answeredAt time of the answer on the vehicle's clock
    * @param receivedAt when the answer passed
    */
  def exchanged(vehicle: String, sentAt: Instant, answeredAt: Instant, receivedAt: Instant): Unit =
    for known <- vehicles.get(vehicle)(Vehicle(vehicle)) do
      val exchange = Stamped((), answeredAt, sentAt, receivedAt)
      known.clock = Some(known.clock.fold(ClockAlignment.of(exchange))(_.updated(exchange)))

  private def received(
      vehicle: String,
      topic: String,
      kind: TopicKind,
      stamp: Option[Instant],
      at: Instant
  ): Option[Vehicle] =
    added += 1
    if begunAt.isEmpty then begunAt = Some(at)
    lastAt = lastAt.max(at)
    val known =
      for
        of    <- vehicles.get(vehicle)(Vehicle(vehicle))
        about <- topics.get(topic)(Topic(topic, kind))
      yield
        about.add(stamp, at)
        of
    if known.isEmpty then notKept += 1
    known

  /** Number of readings and commands so far, kept or not. */
  def messages: Long = added

  /** The progress, at constant cost for any number of observations. */
  def progress: Progress = VehicleAccount.progress(lasted, vehicles.all.map(_.account))

  private def lasted: Span = begunAt.fold(Span.Zero)(lastAt.since)

  /** Commands since the last call, for each vehicle. */
  def takeNew(): Vector[NewCommands] = vehicles.all.flatMap(_.account.takeNew()).toVector

  /** The complete observations so far; sorts every sample. */
  def observed: ObservedTopics = ObservedTopics(
    lasted,
    vehicles.all.map(_.account.observed).toVector,
    topics.all.map(_.observed).toVector,
    caused,
    vehicles.all.filter(_.isByOtherClock).map(_.name).toVector,
    notKept,
    log.toVector,
    simulated = None
  )

object TopicAccount:
  /** Greatest difference on one clock between a stamp and the time of its message. */
  val SameClock: Span = Span.ofSeconds(10)

  private val MostVehicles = 256
  private val MostTopics   = 1024

  /** Number of readings among which a command's cause is sought. */
  private val MostCauses = 256

  private def isNear(stamp: Instant, at: Instant): Boolean =
    at.since(stamp) <= SameClock && stamp.since(at) <= SameClock

  private final case class Reading(stamp: Option[Instant], at: Instant)

  private final class Vehicle(val name: String):
    val account        = VehicleAccount(name)
    var newest         = Option.empty[Reading]
    var clock          = Option.empty[ClockAlignment]
    private val stamps = mutable.LinkedHashMap.empty[Instant, Reading]

    private var isFirst = true
    private var fastest = Option.empty[FastestMessage]

    def isByOtherClock: Boolean = clock.isEmpty && fastest.isDefined

    /** Half width of the uncertainty of ages; absent if the clocks were not compared. */
    def boundMs: Option[Double] = clock.map(_.uncertainty.toMillis)

    def read(stamp: Option[Instant], at: Instant): Unit =
      val reading = Reading(stamp, at)
      for stamped <- stamp do
        if isFirst && !isNear(stamped, at) then fastest = Some(FastestMessage(at.since(stamped), at))
        isFirst = false
        val before = fastest
        fastest = fastest.map(_.updated(stamped, at))
        // The clock of a restarted vehicle starts again.
        if before.exists(one => fastest.exists(_.offset > one.offset + FastestMessage.Restart)) then
          newest = None
          stamps.clear()
          clock = None
        stamps(stamped) = reading
        if stamps.size > MostCauses then stamps -= stamps.head._1
      // A message that overtook a newer one is not a newer reading.
      if newest.flatMap(_.stamp).forall(before => stamp.forall(_ >= before)) then newest = Some(reading)

    def readingOf(stamp: Instant): Option[Reading] = stamps.get(stamp)

    def ageMs(reading: Reading, now: Instant): Double =
      val offset = clock.map(_.offset).orElse(fastest.map(_.offset)).getOrElse(Span.Zero)
      now.since(reading.stamp.fold(reading.at)(_ + offset)).toMillis

  private final class Topic(name: String, kind: TopicKind):
    private val between   = Samples()
    private val late      = Samples()
    private var messages  = 0L
    private var backwards = 0L
    private var last      = Option.empty[Instant]
    private var newest    = Option.empty[Instant]

    def add(stamp: Option[Instant], at: Instant): Unit =
      messages += 1
      last.foreach(before => between.add(at.since(before).toMillis))
      last = Some(at)
      for stamped <- stamp do
        if newest.exists(_ > stamped) then backwards += 1
        newest = Some(newest.fold(stamped)(_.max(stamped)))
        if isNear(stamped, at) then late.add(at.since(stamped).toMillis)

    def observed: ObservedTopic =
      val intervals = between.distribution
      ObservedTopic(
        name,
        kind,
        messages,
        intervals,
        late.distribution,
        intervals.fold(0L)(all => all.sorted.count(_ > GapFactor * all.median).toLong),
        backwards
      )

  /** A gap is an interval longer than this multiple of the usual one. */
  private val GapFactor = 2.5

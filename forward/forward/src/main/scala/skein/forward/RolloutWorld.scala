package skein.forward

import skein.policy.{Action, Assignment, Seen}
import skein.scenario.Known
import skein.signal.{Kinematics, SplitMix64, Stamped}
import skein.units.Span
import skein.vehicle.NoisySensor

/** The environment of a simulated loop: the vehicles of an engagement, the time, and the messages on their
  * way to and from the vehicles. Mutable; during a flight only the vehicles allocate.
  *
  * @param keepsAll whether readings are kept whole, not just positions and velocities
  * @param asksPolicies whether policies decide; if not, vehicles keep their headings, since only the times of
  *   events matter
  * @param standsStill whether the world stands still during decisions
  * @param ring [[RolloutWorld.ringOf]]
  */
private[skein] final class RolloutWorld(
    engagement: Engagement,
    link: Delays,
    val responses: Vector[VelocityResponse],
    asking: Asking,
    keepsAll: Boolean,
    val asksPolicies: Boolean,
    val standsStill: Boolean,
    val ring: Int
):
  import RolloutWorld.*

  val agents: Array[RolloutAgent] = engagement.agents.toArray
  val assignment: Assignment      = engagement.assignment

  /** Whether readings are kept whole, with attitude and rates. */
  val keepsKinematics: Boolean = keepsAll || asksPolicies || engagement.isOver.isDefined

  val count: Int                     = agents.length
  val vehicles: Array[Vehicle]       = responses.map(_.create()).toArray
  private val sensors                = Array.fill(agents.length)(Option.empty[NoisySensor])
  private val queue                  = EventQueue(MostWaiting * agents.length)
  private val handoverNs             = responses.map(response => Nanos.of(response.handoverS)).toArray
  private val timeoutNs              = Nanos.of(asking.timeoutS)
  private var key                    = 0
  private var time                   = 0L
  private var watching: LoopObserver = LoopObserver.Nobody

  // Readings by vehicle and request, see `slot`: what they showed, and when.
  val x, y                                  = Array.ofDim[Double](count * ring)
  val sentAtNs, validAtNs, receivedAtNs     = Array.ofDim[Long](count * ring)
  private val kinematics: Array[Kinematics] =
    Array.ofDim[Kinematics](if keepsKinematics then count * ring else 0)
  private val steps, askers = Array.ofDim[Int](count * ring)
  private val asked         = Array.ofDim[Int](count)

  // Commands by vehicle and number.
  private val actions          = Array.ofDim[Action](count * ring)
  private val commandSteps     = Array.ofDim[Int](count * ring)
  private val commanded        = Array.ofDim[Int](count)
  private val commandAt, ackAt = Array.ofDim[Long](count)

  /** Resets to the start of an episode.
    *
    * @param firstQuestion the number of each vehicle's next request
    * @param sensorSeed of the errors of readings, by default the key
    */
  def start(
      worldKey: Int,
      listener: LoopObserver,
      firstQuestion: Int = 0,
      sensorSeed: Option[Long] = None
  ): Unit =
    key = worldKey
    time = 0
    watching = listener
    ended = false
    begunAtNs = RolloutWorld.NotBegun
    queue.clear()
    for vehicle <- vehicles.indices do
      sensors(vehicle) =
        responses(vehicle).sensors.map: noise =>
          NoisySensor(noise, SplitMix64.seedOf(sensorSeed.getOrElse(worldKey), vehicle))
      vehicles(vehicle).start(agents(vehicle).startX, agents(vehicle).startY, agents(vehicle).altitudeDownM)
      asked(vehicle) = firstQuestion; commanded(vehicle) = 0; commandAt(vehicle) = 0; ackAt(vehicle) = 0

  private var begunAtNs = RolloutWorld.NotBegun
  private var ended     = false

  /** Whether the engagement was over when it was last evaluated. */
  def isOver: Boolean = ended

  private def known(upon: Grounds): Known = Known(
    Span.ofNanos(time - begunAtNs),
    Vector.tabulate(count): vehicle =>
      Seen(
        kinematics(slot(vehicle, upon.reading(vehicle))),
        Span.ofNanos(time - upon.validAtNs(vehicle)),
        isPredicted = false
      )
  )

  /** Receives the events of the episode, such as readings and commands. */
  def observer: LoopObserver = watching

  /** By vehicle: its source of knowledge of the opponent, if it is not readings. */
  val views: Array[Option[OpponentView]] = Array.fill(count)(None)

  /** Time since the flight's start, ns. */
  def nowNs: Long = time

  def nowS: Double = time * 1e-9

  /** Schedules an event at a time that is not past. Events of one time happen in the order of these calls. */
  def schedule(atNs: Long, kind: Int, vehicle: Int, number: Int): Unit =
    queue.add(atNs, event(kind, vehicle, number))

  private def event(kind: Int, vehicle: Int, number: Int) =
    (kind.toLong << 40) | (vehicle.toLong << 32) | number

  def nextNs: Long = queue.nextTime

  def next(): Long =
    time = queue.nextTime
    queue.take()

  /** Index of a request or command of a vehicle, in arrays of `count * ring`. */
  def slot(vehicle: Int, number: Int): Int = vehicle * ring + number % ring

  def stepOf(vehicle: Int, question: Int): Int      = steps(slot(vehicle, question))
  def askerOf(vehicle: Int, question: Int): Int     = askers(slot(vehicle, question))
  def seen(vehicle: Int, question: Int): Kinematics = kinematics(slot(vehicle, question))

  /** Requests a reading of a vehicle; [[Answered]] or [[TimedOut]] follows, the latter also when the answer
    * says that sensors have no reading.
    *
    * @return the request's number: they count per vehicle, over all controllers
    */
  def ask(asker: Int, vehicle: Int, step: Int): Int =
    val number = asked(vehicle)
    val at     = slot(vehicle, number)
    asked(vehicle) += 1
    steps(at) = step; askers(at) = asker; sentAtNs(at) = time
    val delay = link.delayNs(key, Delays.question(asker, vehicle), step, number, time)
    if delay > timeoutNs then timeOut(vehicle, number)
    else schedule(time + delay, Sampled, vehicle, number)
    number

  def sampled(vehicle: Int, number: Int): Unit =
    val at = slot(vehicle, number)
    read(vehicle, number)
    val delay  = link.delayNs(key, Delays.answer(askers(at), vehicle), steps(at), number, time)
    val answer = if sensors(vehicle).exists(_.isMissing(Span.ofNanos(time))) then TimedOut else Answered
    if delay > sentAtNs(at) + timeoutNs - time then timeOut(vehicle, number)
    else schedule(time + delay, answer, vehicle, number)

  /** Schedules a time-out after all other events of its time, as in a flight (`skein.rpc.ChannelStage`). */
  private def timeOut(vehicle: Int, number: Int): Unit =
    queue.addLast(sentAtNs(slot(vehicle, number)) + timeoutNs, event(TimedOut, vehicle, number))

  def received(vehicle: Int, number: Int): Unit =
    receivedAtNs(slot(vehicle, number)) = time

  /** Whether a reading, by its [[slot]], is newer than one of these times. */
  def isNewer(slot: Int, thanValidAtNs: Long, thanReceivedAtNs: Long): Boolean =
    Stamped.isNewer(validAtNs(slot), sentAtNs(slot), thanValidAtNs, thanReceivedAtNs)

  def readNow(vehicle: Int, step: Int): Int =
    val number = asked(vehicle)
    asked(vehicle) += 1
    steps(slot(vehicle, number)) = step
    read(vehicle, number)
    number

  private def read(vehicle: Int, number: Int): Unit =
    val body = vehicles(vehicle)
    val at   = slot(vehicle, number)
    body.advance(nowS)
    sensors(vehicle) match
      case None =>
        x(at) = body.seenX; y(at) = body.seenY
        if keepsKinematics then kinematics(at) = body.seen
      case Some(sensor) =>
        val sensed = sensor.read(body.seen, Span.ofNanos(time))
        x(at) = sensed.positionNed.x; y(at) = sensed.positionNed.y
        if keepsKinematics then kinematics(at) = sensed
    validAtNs(at) = time
    observer.read(vehicle, number, time, x(at), y(at), body.seenZ)

  /** Sends a command; [[Acknowledged]] follows when a newer one has replaced it.
    *
    * @return its number
    */
  def send(agent: Int, action: Action, step: Int): Int =
    val number = commanded(agent)
    commanded(agent) += 1
    actions(slot(agent, number)) = action
    commandSteps(slot(agent, number)) = step
    observer.commanded(agent, number, time, action)
    commandAt(agent) =
      math.max(commandAt(agent), time + link.delayNs(key, Delays.command(agent), step, number, time))
    schedule(commandAt(agent), Arrived, agent, number)
    number

  /** Called when a command reaches the vehicle: it takes effect now or after the handover, and the previous
    * command is answered.
    */
  def arrived(agent: Int, number: Int): Unit =
    if number == 0 then acts(agent, number)
    else
      val step  = commandSteps(slot(agent, number))
      val delay = link.delayNs(key, Delays.acknowledgement(agent), step, number - 1, time)
      ackAt(agent) = math.max(ackAt(agent), time + delay)
      schedule(ackAt(agent), Acknowledged, agent, number - 1)
      if handoverNs(agent) == 0 then acts(agent, number)
      else schedule(time + handoverNs(agent), Acts, agent, number)

  def acts(agent: Int, number: Int): Unit =
    observer.acts(agent, number, time)
    act(agent, actions(slot(agent, number)))

  def commandNow(agent: Int, action: Action): Unit =
    observer.commanded(agent, commanded(agent), time, action)
    observer.acts(agent, commanded(agent), time)
    commanded(agent) += 1
    act(agent, action)

  def decided(agent: Int, elapsedS: Double, upon: Grounds): Unit =
    observer.decided(agent, time, elapsedS, upon)
    for isOver <- engagement.isOver do
      if begunAtNs == RolloutWorld.NotBegun then begunAtNs = time
      ended ||= isOver(known(upon))

  private def act(agent: Int, action: Action): Unit =
    vehicles(agent).advance(nowS)
    vehicles(agent).act(action)

private[skein] object RolloutWorld:
  private val NotBegun = -1L

  // Kinds of events.
  val ScoreNow      = 0
  val Tick          = 1
  val Sampled       = 2
  val Answered      = 3
  val TimedOut      = 4
  val Arrived       = 5
  val Acts          = 6
  val Acknowledged  = 7
  val Wake          = 8
  val Patience      = 9
  val Due           = 10
  val Look          = 11
  val Exposed       = 12
  val ImageReceived = 13
  val Recognised    = 14

  def kindOf(event: Long): Int    = (event >>> 40).toInt
  def vehicleOf(event: Long): Int = (event >>> 32).toInt & 0xff
  def numberOf(event: Long): Int  = event.toInt

  /** Maximum number of unanswered requests and commands of one vehicle if the vehicles are read in sequence:
    * more than any window allows.
    */
  val Ring = 64

  /** Number of the newest requests and commands of a vehicle that must be kept. A task of `Futures` reads all
    * vehicles in sequence, each within the time-out, and needs its first reading at the end; every vehicle
    * may have begun a task in every period since. Loops that read every period compare an answer with the
    * last delivered one, whose request may be as old again.
    */
  def ringOf(timing: LoopTiming, vehicles: Int): Int =
    val asking                 = timing.asking
    def periods(timeS: Double) = math.ceil(timeS / timing.periodS)
    val needed: Double         = timing match
      case _: LoopTiming.Futures => vehicles * (periods(vehicles * asking.timeoutS) + asking.window + 1)
      case _: (LoopTiming.Stream | LoopTiming.Predictive) => 2 * periods(asking.timeoutS) + asking.window + 2
      case _                                              => Ring
    require(
      needed <= MostRing,
      s"at most $MostRing questions of a vehicle can be kept, $timing may need $needed"
    )
    needed.toInt.max(Ring)

  private val MostRing = 1 << 16

  /** Maximum number of scheduled events of one vehicle. */
  private val MostWaiting = 512

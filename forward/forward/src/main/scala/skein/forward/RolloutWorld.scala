package skein.forward

import skein.policy.{Assignment, HeadingPolicy}
import skein.signal.{Kinematics, Stamped}

/** What a loop finds outside of itself: the vehicles of an engagement, the time, and the messages on their
  * way to and from the vehicles. Mutable; allocates nothing while it flies but what the vehicles do.
  *
  * @param keepsAll keeps all that readings tell, not just places and velocities
  * @param standsStill while it is decided
  * @param ring [[RolloutWorld.ringOf]]
  */
private[skein] final class RolloutWorld(
    engagement: Engagement,
    link: Delays,
    model: VelocityResponse,
    asking: Asking,
    keepsAll: Boolean,
    val standsStill: Boolean,
    val ring: Int
):
  import RolloutWorld.*

  val agents: Array[RolloutAgent] = engagement.agents.toArray
  val assignment: Assignment      = engagement.assignment

  /** By vehicle: whether its policy is asked as any is, and not by numbers alone. */
  val isAsked: Array[Boolean] = agents.map(!_.policy.isInstanceOf[HeadingPolicy])

  /** Whether all that readings tell is kept. */
  val keepsKinematics: Boolean = keepsAll || isAsked.contains(true)

  /** Whether a vehicle flies otherwise when it is told to turn. */
  val regardsYaw: Boolean            = model.regardsYaw
  val count: Int                     = agents.length
  val vehicles: Array[Vehicle]       = Array.fill(count)(model.create())
  private val queue                  = EventQueue(MostWaiting * agents.length)
  private val handoverNs             = Nanos.of(model.handoverS)
  private val timeoutNs              = Nanos.of(asking.timeoutS)
  private var key                    = 0
  private var time                   = 0L
  private var watching: LoopObserver = LoopObserver.Nobody

  // Readings by vehicle and the question's number, see `slot`: what they showed, and when.
  val x, y, vx, vy                          = Array.ofDim[Double](count * ring)
  val sentAtNs, validAtNs, receivedAtNs     = Array.ofDim[Long](count * ring)
  private val kinematics: Array[Kinematics] =
    Array.ofDim[Kinematics](if keepsKinematics then count * ring else 0)
  private val steps, askers = Array.ofDim[Int](count * ring)
  private val asked         = Array.ofDim[Int](count)

  // Commands by vehicle and number.
  private val norths, easts    = Array.ofDim[Double](count * ring)
  private val commandSteps     = Array.ofDim[Int](count * ring)
  private val commanded        = Array.ofDim[Int](count)
  private val commandAt, ackAt = Array.ofDim[Long](count)

  /** Back to the start of an episode.
    *
    * @param firstQuestion the number of each vehicle's next question
    */
  def start(worldKey: Int, listener: LoopObserver, firstQuestion: Int = 0): Unit =
    key = worldKey
    time = 0
    watching = listener
    queue.clear()
    for vehicle <- vehicles.indices do
      vehicles(vehicle).start(agents(vehicle).startX, agents(vehicle).startY, agents(vehicle).altitudeDownM)
      asked(vehicle) = firstQuestion; commanded(vehicle) = 0; commandAt(vehicle) = 0; ackAt(vehicle) = 0

  /** Is told what happens. */
  def observer: LoopObserver = watching

  /** By which each vehicle knows of its opponent that does not by readings. */
  val views: Array[Option[OpponentView]] = Array.fill(count)(None)

  /** Since the flight's start, ns. */
  def nowNs: Long = time

  def nowS: Double = time * 1e-9

  /** Lets an event happen at a time that is not past. Events of one time happen in the order of these calls.
    */
  def schedule(atNs: Long, kind: Int, vehicle: Int, number: Int): Unit =
    queue.add(atNs, (kind.toLong << 40) | (vehicle.toLong << 32) | number)

  /** When the next event happens. */
  def nextNs: Long = queue.nextTime

  /** Lets time pass up to the next event. */
  def next(): Long =
    time = queue.nextTime
    queue.take()

  /** Of a question or command to a vehicle, in arrays of `count * ring`. */
  def slot(vehicle: Int, number: Int): Int = vehicle * ring + number % ring

  def stepOf(vehicle: Int, question: Int): Int      = steps(slot(vehicle, question))
  def askerOf(vehicle: Int, question: Int): Int     = askers(slot(vehicle, question))
  def seen(vehicle: Int, question: Int): Kinematics = kinematics(slot(vehicle, question))

  /** Asks a vehicle where it is; [[Answered]] or [[TimedOut]] follows.
    *
    * @return the question's number: they count for each vehicle, whoever asks
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

  /** The question has reached the vehicle. */
  def sampled(vehicle: Int, number: Int): Unit =
    val at = slot(vehicle, number)
    read(vehicle, number)
    val delay = link.delayNs(key, Delays.answer(askers(at), vehicle), steps(at), number, time)
    if delay > sentAtNs(at) + timeoutNs - time then timeOut(vehicle, number)
    else schedule(time + delay, Answered, vehicle, number)

  private def timeOut(vehicle: Int, number: Int): Unit =
    schedule(sentAtNs(slot(vehicle, number)) + timeoutNs, TimedOut, vehicle, number)

  /** The answer has come back. */
  def received(vehicle: Int, number: Int): Unit = receivedAtNs(slot(vehicle, number)) = time

  /** Whether a reading, by its [[slot]], is newer than one of these times. */
  def isNewer(slot: Int, thanValidAtNs: Long, thanReceivedAtNs: Long): Boolean =
    Stamped.isNewer(validAtNs(slot), sentAtNs(slot), thanValidAtNs, thanReceivedAtNs)

  /** Reads a vehicle without any message. */
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
    x(at) = body.seenX; y(at) = body.seenY; vx(at) = body.seenVx; vy(at) = body.seenVy
    if keepsKinematics then kinematics(at) = body.seen
    validAtNs(at) = time
    observer.read(vehicle, number, time, x(at), y(at))

  /** Sends a command; [[Acknowledged]] follows when a newer one has replaced it.
    *
    * @return its number
    */
  def send(
      agent: Int,
      headingRad: Double,
      speedMps: Double,
      northMps: Double,
      eastMps: Double,
      step: Int
  ): Int =
    val number = commanded(agent)
    commanded(agent) += 1
    norths(slot(agent, number)) = northMps
    easts(slot(agent, number)) = eastMps
    commandSteps(slot(agent, number)) = step
    observer.commanded(agent, number, time, headingRad, speedMps)
    commandAt(agent) =
      math.max(commandAt(agent), time + link.delayNs(key, Delays.command(agent), step, number, time))
    schedule(commandAt(agent), Arrived, agent, number)
    number

  /** The command has reached the vehicle: it acts, now or after the handover, and the one before is answered.
    */
  def arrived(agent: Int, number: Int): Unit =
    if number == 0 then acts(agent, number)
    else
      val step  = commandSteps(slot(agent, number))
      val delay = link.delayNs(key, Delays.acknowledgement(agent), step, number - 1, time)
      ackAt(agent) = math.max(ackAt(agent), time + delay)
      schedule(ackAt(agent), Acknowledged, agent, number - 1)
      if handoverNs == 0 then acts(agent, number) else schedule(time + handoverNs, Acts, agent, number)

  def acts(agent: Int, number: Int): Unit =
    observer.acts(agent, number, time)
    command(agent, norths(slot(agent, number)), easts(slot(agent, number)))

  /** Commands a vehicle without any message. */
  def commandNow(agent: Int, headingRad: Double, speedMps: Double, northMps: Double, eastMps: Double): Unit =
    observer.commanded(agent, commanded(agent), time, headingRad, speedMps)
    observer.acts(agent, commanded(agent), time)
    commanded(agent) += 1
    command(agent, northMps, eastMps)

  /** A decision was made. */
  def decided(agent: Int, elapsedS: Double, upon: Grounds): Unit =
    observer.decided(agent, time, elapsedS, upon)

  private def command(agent: Int, northMps: Double, eastMps: Double): Unit =
    vehicles(agent).advance(nowS)
    vehicles(agent).command(northMps, eastMps)

private[skein] object RolloutWorld:
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

  /** Questions and commands of one vehicle that may be under way where each vehicle is asked in turn: more
    * than any window allows.
    */
  val Ring = 64

  /** How many of one vehicle's newest questions and commands must be kept. A task of `Futures` reads all
    * vehicles one after the other, each within the time-out, and needs its first reading at the end, when
    * each of the vehicles may have begun a task in every period since. Loops that ask every period compare an
    * answer with the one told last, whose question may be as old again.
    */
  def ringOf(timing: LoopTiming, vehicles: Int): Int =
    val asking                 = LoopTiming.askingOf(timing)
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

  /** Events of one vehicle that may be waiting. */
  private val MostWaiting = 512

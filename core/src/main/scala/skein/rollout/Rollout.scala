package skein.rollout

/** Flies duels under a loop's real timing: the scalar reference, readable and in double. Events are processed in the
  * order of their times; between them the vehicles fly by themselves. Mutable: one per thread; an episode allocates
  * nothing but what the policies and the quadrotor's setpoints need.
  *
  * @param link
  *   delays of questions, answers, commands and acknowledgements; `Paused` ignores it
  */
final class Rollout(duel: Duel, timing: LoopTiming, link: DelayTable, model: VelocityResponse):
  import Rollout.*

  private val agents   = Array(duel.evader, duel.pursuer)
  private val vehicles = Array.fill(2)(model.create())
  private val queue    = EventQueue(MostWaiting)
  private val scores   = (duel.durationS / timing.periodS).round.toInt
  private var key      = 0
  private var now      = 0.0

  // Readings by chain, vehicle and step, from the sampling until the decision.
  private val readX, readY, readVx, readVy = Array.ofDim[Double](Chains * 2 * Ring)

  /** When the last message of each kind arrived, so that the next one comes after it; by chain and vehicle. */
  private val questionAt, answerAt = Array.ofDim[Double](Chains * 2)
  private val commandAt, ackAt     = Array.ofDim[Double](2)

  /** How many questions each vehicle has answered (`Stream`). */
  private val answered = Array.ofDim[Int](2)

  private val heading     = Array.ofDim[Double](2) // last decided
  private val sentHeading = Array.ofDim[Double](2) // last sent, as the opponent's policy knows it
  private val decidedAt   = Array.ofDim[Double](2)
  private val effort      = Array.ofDim[Double](2)
  private val outstanding = Array.ofDim[Int](2)    // commands sent and not acknowledged
  private val waitingStep = Array.ofDim[Int](2) // picture or decision that waits to leave; None if none does
  private val turnAt      = Array.ofDim[Double](2)
  private val ringHeading = Array.ofDim[Double](2 * Ring)
  private val flown = Array.ofDim[Boolean](2) // whether a command has reached the vehicle

  private var score                 = Score()
  private var decisions, skipped    = 0
  private var listener: Listener    = NoListener
  private val fresh: Array[Boolean] = Array.ofDim[Boolean](2)

  /** Flies one episode.
    *
    * @param worldKey
    *   of [[WorldRandom]]: decides all delays
    */
  def fly(worldKey: Int, captureRadiusM: Double = 0.0, onScore: Listener = NoListener): Outcome =
    start(worldKey, captureRadiusM, onScore)
    while score.count < scores do
      now = queue.nextTime
      handle(queue.take())
    score.outcome(effort(Pursuer), effort(Evader), decisions, skipped)

  private def start(worldKey: Int, captureRadiusM: Double, onScore: Listener): Unit =
    key = worldKey
    now = 0
    queue.clear()
    listener = onScore
    score = Score(captureRadiusM, duel.durationS)
    decisions = 0; skipped = 0
    for i <- questionAt.indices do
      questionAt(i) = 0; answerAt(i) = 0
    for agent <- 0 to 1 do
      vehicles(agent).start(agents(agent).startX, agents(agent).startY, agents(agent).altitudeDownM)
      heading(agent) = agents(agent).startHeadingRad
      sentHeading(agent) = heading(agent)
      decidedAt(agent) = Double.NaN; effort(agent) = 0
      commandAt(agent) = 0; ackAt(agent) = 0; turnAt(agent) = Double.NegativeInfinity
      answered(agent) = 0; outstanding(agent) = 0; waitingStep(agent) = None; flown(agent) = false
    queue.add(timing.periodS, event(ScoreNow, 0, 0, 1))
    queue.add(0, event(Step, 0, 0, 0))

  private def handle(event: Long): Unit =
    val step  = event.toInt
    val agent = (event >>> 32).toInt & 1
    val chain = (event >>> 33).toInt & 3
    (event >>> 36).toInt match
      case ScoreNow => scoreNow(step)
      case Step     => begin(step)
      case Ask      => ask(chain, agent, step)
      case Sampled  => sampled(chain, agent, step)
      case Arrived  => arrived(chain, agent, step)
      case Due      => decideReady()
      case Applied  => applied(agent, step)
      case Acked    =>
        outstanding(agent) -= 1
        timing match
          case _: LoopTiming.Stream => decideReady()
          case _                    => sendWaiting(agent)

  private def begin(step: Int): Unit = timing match
    case LoopTiming.Paused(period) =>
      for vehicle <- 0 to 1 do read(Common, vehicle, step)
      decideBoth(step)
      queue.add((step + 1) * period, event(Step, 0, 0, step + 1))
    case LoopTiming.Sequential(_)   => ask(Common, Evader, step)
    case LoopTiming.Futures(period) =>
      for chain <- 0 to 1 do ask(chain, Evader, step)
      queue.add((step + 1) * period, event(Step, 0, 0, step + 1))
    case LoopTiming.Stream(period, _) =>
      for vehicle <- 0 to 1 do ask(Common, vehicle, step)
      queue.add((step + 1) * period, event(Step, 0, 0, step + 1))

  private def ask(chain: Int, vehicle: Int, step: Int): Unit =
    val line = 2 * chain + vehicle
    questionAt(line) = math.max(questionAt(line), now + delay(step, sensePlace(chain, vehicle)))
    queue.add(questionAt(line), event(Sampled, chain, vehicle, step))

  private def sampled(chain: Int, vehicle: Int, step: Int): Unit =
    read(chain, vehicle, step)
    val line = 2 * chain + vehicle
    answerAt(line) = math.max(answerAt(line), now + delay(step, sensePlace(chain, vehicle) + 1))
    queue.add(answerAt(line), event(Arrived, chain, vehicle, step))

  private def read(chain: Int, vehicle: Int, step: Int): Unit =
    val craft = vehicles(vehicle)
    craft.advance(now)
    val slot = ringSlot(chain, vehicle, step)
    readX(slot) = craft.x; readY(slot) = craft.y; readVx(slot) = craft.vx; readVy(slot) = craft.vy

  private def arrived(chain: Int, vehicle: Int, step: Int): Unit = timing match
    case _: LoopTiming.Stream =>
      answered(vehicle) = step + 1
      if answered(1 - vehicle) >= answered(vehicle) then
        for agent <- 0 to 1 do
          if waitingStep(agent) != None then skipped += 1
          waitingStep(agent) = step
        decideReady()
    case _ if vehicle == Evader        => ask(chain, Pursuer, step)
    case LoopTiming.Futures(_)         => decideOne(chain, step)
    case LoopTiming.Sequential(period) =>
      decideBoth(step)
      queue.add(now + period, event(Step, 0, 0, step + 1))
    case LoopTiming.Paused(_) => ()

  /** `Stream`: decides for every agent whose picture waits and whose turn has come; all on what was sent before. */
  private def decideReady(): Unit = timing match
    case LoopTiming.Stream(period, tolerance) =>
      for agent <- 0 to 1 do
        val earliest = turnAt(agent) - tolerance
        fresh(agent) = waitingStep(agent) != None && outstanding(agent) < LoopTiming.MostOutstanding
        if fresh(agent) && now < earliest then
          fresh(agent) = false
          queue.add(earliest, event(Due, 0, agent, 0))
      for agent <- 0 to 1 if fresh(agent) do decide(agent, Common, waitingStep(agent))
      for agent <- 0 to 1 if fresh(agent) do
        turnAt(agent) = math.max(turnAt(agent), now) + period
        sendWaiting(agent)
    case _ => ()

  private def decideBoth(step: Int): Unit =
    for agent <- 0 to 1 do decide(agent, Common, step)
    for agent <- 0 to 1 do
      waitingStep(agent) = step
      sendWaiting(agent)

  private def decideOne(agent: Int, step: Int): Unit =
    decide(agent, agent, step)
    waitingStep(agent) = step
    sendWaiting(agent)

  private def decide(agent: Int, chain: Int, step: Int): Unit =
    val own     = ringSlot(chain, agent, step)
    val other   = ringSlot(chain, 1 - agent, step)
    val elapsed = if decidedAt(agent).isNaN then 0.0 else now - decidedAt(agent)
    val before  = heading(agent)
    heading(agent) = agents(agent).policy.heading(
      readX(other) - readX(own),
      readY(other) - readY(own),
      readVx(other) - readVx(own),
      readVy(other) - readVy(own),
      heading(agent),
      sentHeading(1 - agent),
      elapsed
    )
    effort(agent) += math.abs(math.IEEEremainder(heading(agent) - before, 2 * math.Pi))
    decidedAt(agent) = now
    decisions += 1

  /** Sends the newest decision if one waits and the commands in flight allow it. */
  private def sendWaiting(agent: Int): Unit =
    val step = waitingStep(agent)
    if step != None && outstanding(agent) < LoopTiming.MostOutstanding then
      waitingStep(agent) = None
      sentHeading(agent) = heading(agent)
      ringHeading(agent * Ring + step % Ring) = heading(agent)
      outstanding(agent) += 1
      commandAt(agent) = math.max(commandAt(agent), now + delay(step, CommandPlace + 2 * agent))
      timing match
        case _: LoopTiming.Paused => applied(agent, step)
        case _                    => queue.add(commandAt(agent), event(Applied, 0, agent, step))

  private def applied(agent: Int, step: Int): Unit =
    val craft = vehicles(agent)
    val angle = ringHeading(agent * Ring + step % Ring)
    craft.advance(now)
    craft.command(agents(agent).speed * math.cos(angle), agents(agent).speed * math.sin(angle))
    timing match
      case _: LoopTiming.Paused => outstanding(agent) = 0
      case _ if flown(agent)    =>
        ackAt(agent) = math.max(ackAt(agent), now + delay(step, CommandPlace + 2 * agent + 1))
        queue.add(ackAt(agent), event(Acked, 0, agent, step))
      case _ => flown(agent) = true

  private def scoreNow(number: Int): Unit =
    for vehicle <- vehicles do vehicle.advance(now)
    val (evader, pursuer) = (vehicles(Evader), vehicles(Pursuer))
    score.add(now, math.hypot(evader.x - pursuer.x, evader.y - pursuer.y))
    listener.scored(now, evader.x, evader.y, pursuer.x, pursuer.y)
    queue.add((number + 1) * timing.periodS, event(ScoreNow, 0, 0, number + 1))

  private def delay(step: Int, place: Int): Double = timing match
    case _: LoopTiming.Paused => 0.0
    case _                    => link.delayS(WorldRandom.bits(key, step * Places + place))

object Rollout:

  /** Is told of every score: both positions, m, at one time, s. */
  trait Listener:
    def scored(timeS: Double, evaderX: Double, evaderY: Double, pursuerX: Double, pursuerY: Double): Unit

  private val NoListener: Listener = (_, _, _, _, _) => ()

  private val Evader  = 0
  private val Pursuer = 1

  /** Who reads: each agent for itself (`Futures`: 0 and 1), or one for both. */
  private val Common = 2
  private val Chains = 3

  /** Steps that a reading or command may be under way. */
  private val Ring = 64

  private val MostWaiting = 1024
  private val None        = -1

  /** Places of the random sequence that belong to one step; the kernels use the same. */
  private[rollout] val Places       = 16
  private[rollout] val CommandPlace = 8

  private[rollout] def sensePlace(chain: Int, vehicle: Int): Int = 4 * (chain % Common) + 2 * vehicle

  private def ringSlot(chain: Int, vehicle: Int, step: Int): Int = (2 * chain + vehicle) * Ring + step % Ring

  private val ScoreNow = 0
  private val Step     = 1
  private val Ask      = 2
  private val Sampled  = 3
  private val Arrived  = 4
  private val Due      = 5
  private val Applied  = 6
  private val Acked    = 7

  private def event(kind: Int, chain: Int, agent: Int, step: Int): Long =
    (kind.toLong << 36) | (chain.toLong << 33) | (agent.toLong << 32) | step

/** Adds up distances as they come. */
private final class Score(captureRadiusM: Double = 0.0, durationS: Double = 0.0):
  var count                = 0
  private var least        = Double.PositiveInfinity
  private var leastAt      = 0.0
  private var sum, lastSum = 0.0
  private var lastCount    = 0
  private var captureS     = Double.PositiveInfinity

  def add(timeS: Double, distanceM: Double): Unit =
    count += 1
    sum += distanceM
    if distanceM < least then
      least = distanceM; leastAt = timeS
    if distanceM <= captureRadiusM && captureS.isInfinite then captureS = timeS
    if timeS > durationS - 10 + 1e-9 then
      lastSum += distanceM
      lastCount += 1

  def outcome(pursuerEffort: Double, evaderEffort: Double, decisions: Int, skipped: Int): Outcome =
    Outcome(
      least,
      leastAt,
      sum / count,
      lastSum / lastCount,
      captureS,
      pursuerEffort,
      evaderEffort,
      decisions,
      skipped
    )

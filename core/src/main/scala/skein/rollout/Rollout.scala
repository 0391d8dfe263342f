package skein.rollout

/** Flies duels under a loop's real timing: the scalar reference, readable and in double. Events happen in the order of
  * their times, in whole nanoseconds; between them the vehicles fly by themselves. Given the delays that a flight in
  * virtual time met ([[RecordedDelays]]) it flies as that did, which `RolloutParitySimulation` holds it to. Mutable: one
  * per thread; an episode allocates nothing but what the policies, the quadrotor's setpoints and the `predictive` loop's
  * forecast need.
  *
  * @param link
  *   delays of questions, answers, commands and acknowledgements; `Paused` ignores it
  */
final class Rollout(duel: Duel, timing: LoopTiming, link: Delays, model: VelocityResponse):
  import DuelWorld.*

  private val world = DuelWorld(
    duel,
    link,
    model,
    LoopTiming.askingOf(timing),
    keepsKinematics = timing.isInstanceOf[LoopTiming.Predictive]
  )
  private val loop                       = LoopRun.of(timing, world)
  private val periodNs                   = nanos(timing.periodS)
  private val scores                     = (duel.durationS / timing.periodS).round.toInt
  private var score                      = Score()
  private var listener: Rollout.Listener = Rollout.NoListener

  /** Flies one episode.
    *
    * @param worldKey
    *   of [[WorldRandom]]: decides all delays
    */
  def fly(
      worldKey: Int,
      captureRadiusM: Double = 0.0,
      onScore: Rollout.Listener = Rollout.NoListener,
      observer: LoopObserver = LoopObserver.Nobody
  ): Outcome =
    listener = onScore
    score = Score(captureRadiusM, duel.durationS)
    world.start(worldKey, observer)
    world.schedule(periodNs, ScoreNow, 0, 1)
    for controller <- loop.controllers do controller.start()
    loop.start()
    while score.count < scores do handle(world.next())
    val (evader, pursuer) = (loop.controllers(Evader), loop.controllers(Pursuer))
    score.outcome(
      pursuer.effortRad,
      evader.effortRad,
      evader.decisions + pursuer.decisions,
      evader.skipped + pursuer.skipped
    )

  private def handle(event: Long): Unit =
    val vehicle = vehicleOf(event)
    val number  = numberOf(event)
    kindOf(event) match
      case ScoreNow => scoreNow(number)
      case Tick     => loop.tick(vehicle, number)
      case Sampled  => world.sampled(vehicle, number)
      case Answered =>
        world.received(vehicle, number)
        loop.answered(vehicle, number)
      case TimedOut     => loop.timedOut(vehicle, number)
      case Arrived      => world.arrived(vehicle, number)
      case Acts         => world.acts(vehicle, number)
      case Acknowledged =>
        loop.replaced(vehicle, number)
        loop.controllers(vehicle).acknowledged()
      case Wake     => loop.controllers(vehicle).goOn()
      case Patience => loop.patienceOver()
      case Due      => loop.due(number)

  private def scoreNow(number: Int): Unit =
    for vehicle <- world.vehicles do vehicle.advance(world.nowS)
    val (evader, pursuer) = (world.vehicles(Evader), world.vehicles(Pursuer))
    score.add(world.nowS, math.hypot(evader.x - pursuer.x, evader.y - pursuer.y))
    listener.scored(world.nowS, evader.x, evader.y, pursuer.x, pursuer.y)
    world.schedule((number + 1) * periodNs, ScoreNow, 0, number + 1)

object Rollout:

  /** Is told of every score: both positions, m, at one time, s. */
  trait Listener:
    def scored(timeS: Double, evaderX: Double, evaderY: Double, pursuerX: Double, pursuerY: Double): Unit

  private val NoListener: Listener = (_, _, _, _, _) => ()

  /** Places of the random sequence that belong to one step; the kernels use the same. */
  private[rollout] val Places: Int       = Delays.Lines
  private[rollout] val CommandPlace: Int = Delays.FirstCommand

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

package skein.torture

import skein.link.{Fault, TimedFault}
import skein.loop.LoopKind
import skein.scenario.{Eye, PaperDuel, Scenario}
import skein.settings.NamedScene
import skein.signal.{LatencyProfile, SplitMix64}
import skein.units.*

/** The faults of one flight, all derived from the seed. Times count from the flight's start.
  *
  * @param calmFrom end of the faults
  * @param faults faults of the link between controller and simulator
  * @param messageFaults faults of single messages until `calmFrom`, as of a broken peer
  * @param restarts restarts of the simulator; afterwards a supervisor prepares the vehicles again
  * @param stopAt when a user ends the flight early
  * @param clockAhead the simulator's clock less the controller's, until a restart
  * @param scene the scene of the simulator's world
  * @param looks whether the last vehicle detects the first by a camera, in addition to the scenario's eyes
  */
final case class FaultPlan(
    seed: Long,
    loop: LoopKind,
    scenario: Scenario,
    link: LatencyProfile,
    cutsSegments: Boolean,
    duration: Span,
    calmFrom: Span,
    faults: Vector[TimedFault],
    messageFaults: MessageFaults,
    restarts: Vector[Restart],
    disk: Disk,
    stopAt: Option[Span],
    clockAhead: Span = Span.Zero,
    scene: NamedScene = NamedScene.Empty,
    looks: Boolean = false
):
  /** All eyes of the flight's vehicles. */
  def eyes: Vector[Eye] = scenario.eyes ++
    Option.when(looks)(FaultyEye(scenario.agents.last.name, scenario.agents.head.name, seed))

  /** These faults for another scenario, under `stream` if it has too many vehicles for the drawn loop: loops
    * that read vehicles in turn need a round trip for each, and a paused simulator needs a worker for each.
    */
  def flying(task: Scenario): FaultPlan =
    val most = loop match
      case LoopKind.Paused                        => 4
      case LoopKind.Sequential | LoopKind.Futures => 6
      case _                                      => Int.MaxValue
    copy(scenario = task, loop = if task.agents.size > most then LoopKind.Stream else loop)

  /** Whether the recording is written to a file and read back, which takes longer than most flights: one in
    * ten.
    */
  def isFiled: Boolean = seed % 10 == 0

  override def toString: String =
    val what = Seq(
      Some(
        s"seed $seed: " +
          s"${loop.label}${if scenario.isAsPublished then " as published" else ""}, " +
          s"${scenario.agents.size} vehicles, ${link.name}"
      ),
      Option.when(faults.nonEmpty)(
        faults.map(f => s"${f.fault} at ${f.at.toMillis.round} ms").mkString(", ")
      ),
      Option.when(restarts.nonEmpty)(
        restarts.map(r => s"restart at ${r.at.toMillis.round} ms for ${r.lasts.toMillis.round} ms").mkString(
          ", "
        )
      ),
      Option.when(messageFaults != MessageFaults.None)(messageFaults.toString),
      Option.when(disk != Disk.Sound)(disk.toString),
      Option.when(looks)("with a camera"),
      stopAt.map(at => s"stopped at ${at.toMillis.round} ms")
    )
    what.flatten.mkString("; ")

/** Probabilities of faults per message.
  *
  * @param late an answer is held back for up to `lateBy`, and others overtake it
  * @param doubled an answer arrives twice
  * @param nonsense an answer's result is of another type
  * @param stray a message is added that is not an answer, or the answer to no call
  * @param garbage bytes are added that are not MessagePack
  * @param refused a move is requested by a method name that the simulator does not know
  * @param lost an answer never arrives, though its connection lives
  */
final case class MessageFaults(
    late: Double = 0,
    lateBy: Span = Span.Zero,
    doubled: Double = 0,
    nonsense: Double = 0,
    stray: Double = 0,
    garbage: Double = 0,
    refused: Double = 0,
    lost: Double = 0
)

object MessageFaults:
  val None: MessageFaults = MessageFaults()

/** The simulator ends at `at` and restarts after `lasts`, with its clock off by `clockJump`. */
final case class Restart(at: Span, lasts: Span, clockJump: Span)

/** A fault of the recording's disk: it blocks or fails. */
enum Disk:
  case Sound

  /** The disk accepts nothing for a while; meanwhile the rows must fit into the recorder's queue. */
  case Blocks(at: Span, lasts: Span, capacity: Int)

  case Fails(at: Span)

object FaultPlan:
  /** Time after the last fault within which control must resume: a new connection takes up to 2 s, and an
    * answer lost on an open connection blocks control for at most 1.4 s (see [[skein.airsim.MoveQueue]]).
    */
  val ResumesWithin: Span = Span.ofSeconds(3)

  /** Time without faults at the end of each flight, in which control must resume and continue. */
  val Calm: Span = Span.ofSeconds(5)

  /** Time before the first fault. */
  private val Start = Span.ofMillis(500)

  val Shortest: Span = Start + Calm + Span.ofSeconds(1)

  def of(seed: Long, duration: Span): FaultPlan =
    require(
      duration >= Shortest,
      s"a flight of ${duration.toSeconds} s is too short: ${Shortest.toSeconds} s at least"
    )
    val drawn = Draw(SplitMix64(SplitMix64.seedOf(seed, 0)), seed, duration).faultPlan
    val added = SplitMix64(SplitMix64.seedOf(seed, 1))
    val loses = drawn.copy(messageFaults =
      if added.nextDouble() < 0.3 then drawn.messageFaults.copy(lost = 0.2 * added.nextDouble())
      else drawn.messageFaults
    )
    val looped =
      if added.nextDouble() < 0.1 then
        loses.copy(loop = LoopKind.Paused, scenario = PaperDuel(loses.scenario.agents.size.min(4) / 2))
      else loses
    looped.copy(
      clockAhead = Span.ofSeconds(40 * added.nextDouble() - 20),
      looks = looped.loop != LoopKind.Paused && added.nextDouble() < 0.2
    )

  private final class Draw(random: SplitMix64, seed: Long, duration: Span):
    private val calmFrom = duration - Calm
    private val trouble  = calmFrom - Start

    def faultPlan: FaultPlan =
      val loop =
        pick(LoopKind.Stream, LoopKind.Stream, LoopKind.Predictive, LoopKind.Futures, LoopKind.Sequential)
      val link = pick(LatencyProfile.none, LatencyProfile.direct, LatencyProfile.vpn, LatencyProfile.vpnMixed)
      // A loop that reads its vehicles in turn needs a round trip for each.
      val most         = if loop == LoopKind.Sequential || loop == LoopKind.Futures then 3 else 10
      val pairs        = if random.nextDouble() < 0.6 then 1 else 1 + random.nextInt(most)
      val cutsSegments = chance(0.5)
      val asPublished  = loop == LoopKind.Stream && chance(0.2)
      FaultPlan(
        seed,
        loop,
        PaperDuel(pairs, asPublished),
        link,
        cutsSegments,
        duration,
        calmFrom,
        several(0.6)(fault()),
        if chance(0.6) then messageFaults() else MessageFaults.None,
        if chance(0.35) then restarts() else Vector.empty,
        disk(),
        Option.when(chance(0.1))(Start + upTo(duration - Start))
      )

    private def fault(): TimedFault =
      val lasts = upTo(trouble.min(Span.ofSeconds(4)))
      val at    = Start + upTo(trouble - lasts)
      TimedFault(at, pick(Fault.Stall(lasts), Fault.Stall(lasts), Fault.Reset, Fault.Silence(lasts)))

    private def messageFaults(): MessageFaults =
      def often(most: Double) = if chance(0.5) then most * random.nextDouble() else 0.0
      MessageFaults(
        often(0.2),
        upTo(Span.ofSeconds(1.5)),
        often(0.3),
        often(0.1),
        often(0.2),
        often(0.02),
        often(0.3)
      )

    /** One restart in each of several equal parts of the faulty time, so that they do not overlap. */
    private def restarts(): Vector[Restart] =
      val count = 1 + random.nextInt((trouble.toSeconds / 4).toInt.max(1).min(5))
      val part  = trouble / count.toLong
      Vector.tabulate(count): index =>
        val lasts = upTo((part / 2).min(Span.ofSeconds(3)))
        val jump  = if chance(0.5) then Span.Zero else upTo(Span.ofSeconds(40)) - Span.ofSeconds(20)
        Restart(Start + part * index.toLong + upTo(part / 2 - Settling), lasts, jump)

    private def disk(): Disk =
      if chance(0.85) then Disk.Sound
      else if chance(0.5) then Disk.Fails(Start + upTo(duration - Start))
      else
        val lasts = upTo(trouble)
        Disk.Blocks(Start + upTo(trouble - lasts), lasts, capacity = 50 + random.nextInt(2000))

    private def several[A](chanceOfMore: Double)(one: => A): Vector[A] =
      Vector.unfold(0)(count => Option.when(count < 20 && chance(chanceOfMore))((one, count + 1)))

    private def chance(p: Double): Boolean = random.nextDouble() < p
    private def upTo(most: Span): Span     = Span.ofNanos((random.nextDouble() * most.toNanos).toLong)
    private def pick[A](choices: A*): A    = choices(random.nextInt(choices.size))

  /** Time for the supervisor's preparation before the next fault. */
  private val Settling = Span.ofMillis(200)

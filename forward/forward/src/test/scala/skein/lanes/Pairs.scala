package skein.lanes

import scala.collection.mutable
import skein.forward.{Delays, EpisodeOutcome, LoopTiming, Pair, Rollout, VelocityResponse}
import skein.lanes.score.{Effort, Judged, OfMoment}
import skein.policy.Policy
import skein.scenario.{Reduction, Separation}

/** Worlds of a pursuer and an evader, for tests that differ only in these two. */
trait PairWorlds extends Worlds:
  def asked: Set[PairNumber] = PairNumber.all
  def pursuer(world: Int): Policy
  def evader(world: Int): Policy

/** The values of a [[EpisodeOutcome]]. */
enum PairNumber(val of: EpisodeOutcome => Double):
  case MinDistance   extends PairNumber(_.minDistanceM)
  case MeanDistance  extends PairNumber(_.meanDistanceM)
  case MeanLast10s   extends PairNumber(_.meanLast10sM)
  case Capture       extends PairNumber(_.captureS)
  case PursuerEffort extends PairNumber(_.pursuerEffortRad)
  case EvaderEffort  extends PairNumber(_.evaderEffortRad)

  def judged(duel: Pair, timing: LoopTiming, captureRadiusM: Double): Judged | Effort = this match
    case MinDistance  => Judged(Separation, Reduction.Least, 0)
    case MeanDistance => Judged(Separation, Reduction.Mean, 0)
    case MeanLast10s  =>
      Judged(Separation, Reduction.Mean, Rollout.last10sFromS(duel.durationS, timing.periodS))
    case Capture       => Judged(Separation, OfMoment.FirstWithin(captureRadiusM), 0)
    case PursuerEffort => Effort(1)
    case EvaderEffort  => Effort(0)

object PairNumber:
  val all: Set[PairNumber] = values.toSet

/** Each world's values; NaN where they were not requested. */
final class PairOutcomes(asked: Set[PairNumber], size: Int, of: TeamOutcomes):
  private val places = PairNumber.values.filter(asked).zipWithIndex.toMap
  private val none   = Array.fill(size)(Float.NaN)

  def flown: Int                              = of.flown
  def apply(number: PairNumber): Array[Float] = places.get(number).fold(none)(of.values(_))
  def minDistanceM: Array[Float]              = this(PairNumber.MinDistance)
  def meanDistanceM: Array[Float]             = this(PairNumber.MeanDistance)
  def meanLast10sM: Array[Float]              = this(PairNumber.MeanLast10s)
  def captureS: Array[Float]                  = this(PairNumber.Capture)
  def pursuerEffortRad: Array[Float]          = this(PairNumber.PursuerEffort)
  def evaderEffortRad: Array[Float]           = this(PairNumber.EvaderEffort)

/** A [[TeamBatch]] of two; the policies come from the worlds. */
final class PairBatch(
    duel: Pair,
    timing: LoopTiming,
    model: VelocityResponse,
    threads: Int = Runtime.getRuntime.availableProcessors,
    accelerator: Option[Accelerator] = None,
    isReference: Boolean = false
):
  private val batch = TeamBatch(timing, model, threads, accelerator, isReference)

  private def candidate(
      pursuer: Policy,
      evader: Policy,
      asked: Set[PairNumber],
      radiusM: Double
  ) =
    TeamCandidate(
      duel.copy(duel.pursuer.copy(policy = pursuer), duel.evader.copy(policy = evader)).engagement,
      PairNumber.values.toVector.filter(asked).map(_.judged(duel, timing, radiusM))
    )

  def engine(
      pursuer: Policy,
      evader: Policy,
      shareEpisodes: Boolean,
      links: Seq[Delays]
  ): Engine =
    batch.engine(candidate(pursuer, evader, PairNumber.all, 0), shareEpisodes, links)

  def fly(
      worlds: PairWorlds,
      captureRadiusM: Double = 0.0,
      onProgress: Int => Unit = _ => (),
      isCancelled: () => Boolean = () => false
  ): PairOutcomes =
    val known = mutable.HashMap.empty[(Policy, Policy), TeamCandidate]
    val teams = Array.tabulate(worlds.size): world =>
      val (pursuer, evader) = (worlds.pursuer(world), worlds.evader(world))
      known.getOrElseUpdate((pursuer, evader), candidate(pursuer, evader, worlds.asked, captureRadiusM))
    val all = new TeamWorlds:
      export worlds.{key, link, size}
      override def shareEpisodes: Boolean      = worlds.shareEpisodes
      override def episodesOfEach: Int         = worlds.episodesOfEach
      def candidate(world: Int): TeamCandidate = teams(world)
    PairOutcomes(worlds.asked, worlds.size, batch.fly(all, onProgress, isCancelled))

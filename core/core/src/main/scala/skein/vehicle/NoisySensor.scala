package skein.vehicle

import skein.signal.{Kinematics, NormalQuantile, OutageTimes, SplitMix64}
import skein.units.*

/** The sensors of one vehicle. Equal seeds give equal errors at equal times, whoever reads and how often.
  * Mutable: it computes drift and outages as far as they are needed. Times count from the vehicle's start and
  * do not decrease.
  */
final class NoisySensor(noise: SensorNoise, seed: Long):
  import NoisySensor.*

  private val drifts =
    Vector.tabulate(if noise.driftM == 0 then 0 else 3)(axis => Drift(noise, SplitMix64.seedOf(seed, axis)))
  private val outages = noise.outage.map(OutageTimes(_, SplitMix64.seedOf(seed, Outages)))

  /** Whether the sensors have no reading of this time. */
  def isMissing(at: Span): Boolean =
    outages.exists(_.isOut(at)) || noise.dropout > 0 && uniform(Dropouts, at) < noise.dropout

  /** The reading of a vehicle's motion; attitude but for the heading, and rates, are true. */
  def read(truth: Kinematics, at: Span): Kinematics =
    def white(first: Int, sd: Double) =
      def error(axis: Int) =
        if sd == 0 then 0.0 else sd * NormalQuantile(uniform(first + axis, at).max(1e-12))
      Vector3(error(0), error(1), error(2))
    val drift =
      if drifts.isEmpty then Vector3.Zero else Vector3(drifts(0)(at), drifts(1)(at), drifts(2)(at))
    truth.copy(
      positionNed = truth.positionNed + white(Positions, noise.positionM) + drift,
      velocityNed = truth.velocityNed + white(Velocities, noise.velocityMps),
      orientation =
        if noise.headingRad == 0 then truth.orientation
        else Quaternion.ofYaw(white(Headings, noise.headingRad).z) * truth.orientation
    )

  private def uniform(quantity: Int, at: Span): Double =
    SplitMix64(SplitMix64.seedOf(SplitMix64.seedOf(seed, quantity), at.toNanos)).nextDouble()

object NoisySensor:
  import SensorNoise.Tick

  // Numbers of the sequences of random numbers, after those of the three drifts.
  private val Outages           = 3
  private val Dropouts          = 4
  private[skein] val Positions  = 5
  private[skein] val Velocities = 8
  private val Headings          = 11

  private final class Drift(noise: SensorNoise, seed: Long):
    private val random  = SplitMix64(seed)
    private val lengths = Tick.toSeconds / noise.driftS
    private var before  = GaussMarkov.next(0, noise.driftM, Double.PositiveInfinity, random)
    private var after   = GaussMarkov.next(before, noise.driftM, lengths, random)
    private var ticks   = 0L

    def apply(at: Span): Double =
      while Tick * (ticks + 1) <= at do
        before = after
        after = GaussMarkov.next(before, noise.driftM, lengths, random)
        ticks += 1
      before + (after - before) * ((at - Tick * ticks).toSeconds / Tick.toSeconds)

package skein.planning

/** A block of candidate manoeuvres, which are drawn, simulated and priced together. Mutable; one per thread.
  * In arrays with one entry per step and candidate, the entry of candidate i in step h has index h · SIZE + i.
  */
private[planning] abstract class CandidateBlock(steps: Int):
  final val turnRates, speeds: Array[Float] = Array.ofDim(steps * CandidateBlock.Size)

  final val costs: Array[Float] = Array.ofDim(CandidateBlock.Size)

  /** Sets the situation and the objective for all manoeuvres that follow. */
  def situate(situation: Situation, objective: PlanCost, dtS: Double): Unit

  /** Draws all candidates, within the limits.
    *
    * @param keys key of each candidate's random stream ([[skein.simd.WorldRandom]])
    * @param stepsPerKnot number of steps that share one random number
    */
  def draw(keys: Array[Int], from: SamplingDistribution, limits: CommandLimits, stepsPerKnot: Int): Unit

  def fly(): Unit

private[planning] object CandidateBlock:
  /** Number of candidates per block: a multiple of every lane count, and few enough for the caches. */
  final val Size = 128

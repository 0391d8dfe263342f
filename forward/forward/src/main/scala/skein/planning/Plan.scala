package skein.planning

/** The best manoeuvre found so far, and the distribution of further candidates. Immutable.
  *
  * @param cost infinite if the manoeuvre was not evaluated in this situation
  * @param slices number of slices searched so far
  * @param candidates number of candidates evaluated so far
  */
final case class Plan(
    manoeuvre: Manoeuvre,
    cost: Float,
    search: SamplingDistribution,
    slices: Int,
    candidates: Long
)

package skein.planning

/** The distribution of candidates: independent normal distributions of each step's actions.
  *
  * @param turnSds standard deviations, rad/s
  * @param speedSds m/s
  */
final case class SamplingDistribution(
    turnMeans: IArray[Float],
    turnSds: IArray[Float],
    speedMeans: IArray[Float],
    speedSds: IArray[Float]
):
  def narrowed(share: Float): SamplingDistribution =
    def narrow(sds: IArray[Float]) =
      val less = Array.ofDim[Float](sds.length)
      for step <- sds.indices do less(step) = sds(step) * share
      IArray.unsafeFromArray(less)
    copy(turnSds = narrow(turnSds), speedSds = narrow(speedSds))

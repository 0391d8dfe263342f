package skein.planning

/** The distribution of candidates: every step's turn rate and speed are independent and normally distributed.
  *
  * @param turnSds standard deviations of the turn rates, rad/s
  * @param speedSds standard deviations of the speeds, m/s
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

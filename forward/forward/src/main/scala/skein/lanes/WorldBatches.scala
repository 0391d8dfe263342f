package skein.lanes

/** Assigns worlds to batches that are simulated together. */
private[lanes] final class WorldBatches(order: Array[Int], starts: Array[Int]):
  def count: Int = starts.length

  def apply(batch: Int): Array[Int] =
    java.util.Arrays.copyOfRange(
      order,
      starts(batch),
      if batch + 1 < starts.length then starts(batch + 1) else order.length
    )

private[lanes] object WorldBatches:
  def inOrder(numbers: Array[Int], most: Int): WorldBatches =
    WorldBatches(numbers, Array.range(0, numbers.length, most))

  /** Groups worlds into batches that share one key and one link.
    *
    * @param numbers indices of the worlds to simulate
    * @param most maximum number of worlds per batch
    */
  def byEpisode(worlds: Worlds, numbers: Array[Int], most: Int): WorldBatches =
    val groups  = java.util.HashMap[(AnyRef, Int), Integer]()
    val groupOf = numbers.map: world =>
      groups.computeIfAbsent((worlds.link(world), worlds.key(world)), _ => groups.size).intValue
    val sizes = Array.ofDim[Int](groups.size)
    for group <- groupOf do sizes(group) += 1
    val ends  = sizes.scanLeft(0)(_ + _)
    val fill  = ends.clone
    val order = Array.ofDim[Int](numbers.length)
    for i <- numbers.indices do
      order(fill(groupOf(i))) = numbers(i)
      fill(groupOf(i)) += 1
    WorldBatches(order, sizes.indices.flatMap(group => ends(group) until ends(group + 1) by most).toArray)

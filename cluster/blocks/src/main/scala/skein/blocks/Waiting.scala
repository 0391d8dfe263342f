package skein.blocks

import scala.collection.immutable.TreeMap

/** Blocks without a worker. Blocks that had a worker before are assigned first, in order of their numbers;
  * then the other blocks, in order of arrival. Each step takes logarithmic time, even with a million blocks.
  *
  * @param again blocks that had a worker, by their numbers; an answer to them may still arrive
  * @param fresh blocks that never had a worker
  */
final case class Waiting private (again: TreeMap[Long, Block], fresh: Vector[Block]):
  def size: Int         = again.size + fresh.size
  def isEmpty: Boolean  = again.isEmpty && fresh.isEmpty
  def nonEmpty: Boolean = !isEmpty

  def iterator: Iterator[Block] = again.valuesIterator ++ fresh.iterator

  /** The next block to assign, and the remaining ones. */
  private[blocks] def next: Option[(Block, Waiting)] =
    again.headOption match
      case Some((number, block)) => Some((block, without(number)))
      case None                  => fresh.headOption.map((_, copy(fresh = fresh.tail)))

  private[blocks] def followedBy(blocks: Iterable[Block]): Waiting = copy(fresh = fresh ++ blocks)

  private[blocks] def returned(block: Block): Waiting = copy(again = again.updated(block.number, block))

  private[blocks] def without(number: Long): Waiting = copy(again = again - number)

private[blocks] object Waiting:
  def apply(): Waiting = Waiting(TreeMap.empty, Vector.empty)

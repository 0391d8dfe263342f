package skein.blocks

import scala.collection.immutable.TreeMap

/** Blocks that nobody has. Those that somebody had go out first, by their numbers; then the others, in the
  * order in which they came. No step takes longer where there are a million.
  *
  * @param again that somebody had, by their numbers; an answer to them may still come
  * @param fresh that nobody ever had
  */
final case class Waiting private (again: TreeMap[Long, Block], fresh: Vector[Block]):
  def size: Int         = again.size + fresh.size
  def isEmpty: Boolean  = again.isEmpty && fresh.isEmpty
  def nonEmpty: Boolean = !isEmpty

  def iterator: Iterator[Block] = again.valuesIterator ++ fresh.iterator

  /** The block that goes out next, and the others. */
  private[blocks] def next: Option[(Block, Waiting)] =
    again.headOption match
      case Some((number, block)) => Some((block, without(number)))
      case None                  => fresh.headOption.map((_, copy(fresh = fresh.tail)))

  private[blocks] def followedBy(blocks: Iterable[Block]): Waiting = copy(fresh = fresh ++ blocks)

  private[blocks] def returned(block: Block): Waiting = copy(again = again.updated(block.number, block))

  private[blocks] def without(number: Long): Waiting = copy(again = again - number)

private[blocks] object Waiting:
  def apply(): Waiting = Waiting(TreeMap.empty, Vector.empty)

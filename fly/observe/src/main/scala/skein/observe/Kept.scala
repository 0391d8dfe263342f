package skein.observe

import scala.collection.mutable

/** Entries by name in the order of their first use, not more than `most`. Mutable. */
private[observe] final class Kept[A](most: Int):
  private val entries = mutable.LinkedHashMap.empty[String, A]

  def all: Iterator[A] = entries.valuesIterator

  /** The entry of a name, made at its first use; None if there are already `most` others. */
  def get(name: String)(make: => A): Option[A] =
    if entries.size < most then Some(entries.getOrElseUpdate(name, make)) else entries.get(name)

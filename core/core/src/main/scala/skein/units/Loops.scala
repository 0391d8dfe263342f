package skein.units

/** Does something with each whole number from 0 to below `count`, without an object for the range or the
  * body: `0 until count` for loops whose time counts.
  */
private[skein] inline def eachBelow(count: Int)(inline body: Int => Unit): Unit = eachFrom(0, count)(body)

/** Does something with each whole number from `first` to below `end`, as [[eachBelow]] does. */
private[skein] inline def eachFrom(first: Int, end: Int)(inline body: Int => Unit): Unit =
  var i = first
  while i < end do
    body(i)
    i += 1

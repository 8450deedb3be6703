! A chain of oscillators for AUTO-07p, of any length:
!   m x_i'' + c x_i' + k x_i + k3 x_i^3 + link (2 x_i - x_i-1 - x_i+1) + stop max(x_i - gap, 0)
!     = F cos(Omega t) for i = 1, 0 for others,
! first order in (x, v), the excitation by an oscillator of its own, u^2 + w^2 = 1. The file `problem` holds
! Omega, m, c, k, k3, link, F, stop, gap, and how many of the first oscillators have k3.

SUBROUTINE FUNC(NDIM, U, ICP, PAR, IJAC, F, DFDU, DFDP)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, IJAC, ICP(*)
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(OUT) :: F(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM, NDIM), DFDP(NDIM, *)
  DOUBLE PRECISION :: R, PULL, STOPPED, CUBIC
  INTEGER :: I, N
  N = (NDIM - 2) / 2
  R = U(NDIM - 1)**2 + U(NDIM)**2
  DO I = 1, N
    PULL = 0
    STOPPED = 0
    IF (I > 1) PULL = PULL + U(I) - U(I - 1)
    IF (I < N) PULL = PULL + U(I) - U(I + 1)
    F(I) = U(N + I)
    CUBIC = MERGE(PAR(5), 0D0, I <= PAR(10))
    IF (U(I) > PAR(9)) STOPPED = PAR(8) * (U(I) - PAR(9))
    F(N + I) = -(PAR(3) * U(N + I) + PAR(4) * U(I) + CUBIC * U(I)**3 + PAR(6) * PULL + STOPPED) / PAR(2)
  END DO
  F(N + 1) = F(N + 1) + PAR(7) * U(NDIM - 1) / PAR(2)
  F(NDIM - 1) = U(NDIM - 1) - PAR(1) * U(NDIM) - U(NDIM - 1) * R
  F(NDIM) = PAR(1) * U(NDIM - 1) + U(NDIM) - U(NDIM) * R
  IF (IJAC == 0) RETURN
  DFDU = 0
  DO I = 1, N
    DFDU(I, N + I) = 1
    DFDU(N + I, N + I) = -PAR(3) / PAR(2)
    CUBIC = MERGE(PAR(5), 0D0, I <= PAR(10))
    DFDU(N + I, I) = -(PAR(4) + 3 * CUBIC * U(I)**2) / PAR(2)
    IF (U(I) > PAR(9)) DFDU(N + I, I) = DFDU(N + I, I) - PAR(8) / PAR(2)
    IF (I > 1) THEN
      DFDU(N + I, I) = DFDU(N + I, I) - PAR(6) / PAR(2)
      DFDU(N + I, I - 1) = PAR(6) / PAR(2)
    END IF
    IF (I < N) THEN
      DFDU(N + I, I) = DFDU(N + I, I) - PAR(6) / PAR(2)
      DFDU(N + I, I + 1) = PAR(6) / PAR(2)
    END IF
  END DO
  DFDU(N + 1, NDIM - 1) = PAR(7) / PAR(2)
  DFDU(NDIM - 1, NDIM - 1) = 1 - R - 2 * U(NDIM - 1)**2
  DFDU(NDIM - 1, NDIM) = -PAR(1) - 2 * U(NDIM - 1) * U(NDIM)
  DFDU(NDIM, NDIM - 1) = PAR(1) - 2 * U(NDIM - 1) * U(NDIM)
  DFDU(NDIM, NDIM) = 1 - R - 2 * U(NDIM)**2
  IF (IJAC == 1) RETURN
  DFDP(:, 1) = 0
  DFDP(NDIM - 1, 1) = -U(NDIM)
  DFDP(NDIM, 1) = U(NDIM - 1)
END SUBROUTINE FUNC

SUBROUTINE STPNT(NDIM, U, PAR, T)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(IN) :: T
  DOUBLE PRECISION :: TPI, AMPLITUDE
  INTEGER :: N
  LOGICAL, SAVE :: BEGUN = .FALSE.
  DOUBLE PRECISION, SAVE :: GIVEN(10)
  IF (.NOT. BEGUN) THEN
    OPEN (77, FILE='problem', STATUS='old')
    READ (77, *) GIVEN
    CLOSE (77)
    BEGUN = .TRUE.
  END IF
  TPI = 8 * ATAN(1D0)
  N = (NDIM - 2) / 2
  PAR(1:10) = GIVEN
  PAR(11) = TPI / PAR(1)
  AMPLITUDE = PAR(7) / (PAR(4) - PAR(2) * PAR(1)**2)
  U = 0
  U(1) = AMPLITUDE * COS(TPI * T)
  U(N + 1) = -AMPLITUDE * PAR(1) * SIN(TPI * T)
  U(NDIM - 1) = COS(TPI * T)
  U(NDIM) = SIN(TPI * T)
END SUBROUTINE STPNT

SUBROUTINE BCND
END SUBROUTINE BCND

SUBROUTINE ICND
END SUBROUTINE ICND

SUBROUTINE FOPT
END SUBROUTINE FOPT

SUBROUTINE PVLS
END SUBROUTINE PVLS

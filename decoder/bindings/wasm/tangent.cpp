// The one function of <math.h> that the decoder needs and WebAssembly has not: for half the angle of a camera, 0 .. pi/2.
extern "C" float tanf(float angle) {
    // The series of sine and cosine. Terms beyond the 20th vanish in doubles for angles below 2.
    const double x = angle;
    double sine = 0, cosine = 0, term = 1;
    for (int n = 0; n < 24; ++n) {
        (n % 2 == 0 ? cosine : sine) += (n & 2) ? -term : term;
        term *= x / (n + 1);
    }
    return static_cast<float>(sine / cosine);
}

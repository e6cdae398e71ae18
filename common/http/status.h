// The status codes that we send or act on (RFC 9110 15, RFC 6585).
#pragma once

namespace chorus::http::status {

inline constexpr int kOk = 200;  ///< Lower codes are not final answers.
inline constexpr int kCreated = 201;
inline constexpr int kAccepted = 202;
inline constexpr int kNoContent = 204;
inline constexpr int kNotModified = 304;
inline constexpr int kPermanentRedirect = 308;
inline constexpr int kBadRequest = 400;  ///< The lowest code of an error.
inline constexpr int kUnauthorized = 401;
inline constexpr int kForbidden = 403;
inline constexpr int kNotFound = 404;
inline constexpr int kMethodNotAllowed = 405;
inline constexpr int kNotAcceptable = 406;
inline constexpr int kRequestTimeout = 408;
inline constexpr int kConflict = 409;
inline constexpr int kGone = 410;
inline constexpr int kLengthRequired = 411;
inline constexpr int kContentTooLarge = 413;
inline constexpr int kUriTooLong = 414;
inline constexpr int kExpectationFailed = 417;
inline constexpr int kMisdirected = 421;
inline constexpr int kTooManyRequests = 429;
inline constexpr int kFieldsTooLarge = 431;
inline constexpr int kInternal = 500;  ///< The lowest code of an error that is the server's fault.
inline constexpr int kNotImplemented = 501;
inline constexpr int kUnavailable = 503;
inline constexpr int kGatewayTimeout = 504;
inline constexpr int kVersionNotSupported = 505;

}  // namespace chorus::http::status
